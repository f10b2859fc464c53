// Does the fire of object `from` reach other objects, and object `to` among them?
bool gives(uint from, uint to) {
    return (exchangeObjects[from].flags & kExchangeLive) != 0u &&
           objectCounters[from].burning != 0u &&
           mayTransfer(exchangeObjects[from], hopsOf(objectCounters[from].litBy), push.hopsMost) &&
           mayReach(push.seed, from, to, objectCounters[from].litTick,
                    multiplyChances(push.chance, exchangeObjects[from].chance));
}
