#!/bin/bash
# The game for fifteen minutes under validation: memory and cost do not grow
# build: tower_defence
set -euo pipefail
exec bash "$(dirname "${BASH_SOURCE[0]}")/../game/game_soak.sh" 15 1.3
