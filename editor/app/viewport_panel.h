// The live picture and what a hand does in it: look around, pick, place, move.
#pragma once

#include "app/app.h"

namespace fwapp {
void showViewport(App& app, const fwui::Rect& rect);
}  // namespace fwapp
