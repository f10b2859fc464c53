// The inspector: all fields of the selection, generated from the document's field table.
#pragma once

#include "app/app.h"

namespace fwapp {
void showInspector(App& app, fwui::Rect rect);
}  // namespace fwapp
