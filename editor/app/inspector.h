// The inspector: every field of what is selected, made from the document's table of fields.
#pragma once

#include "app/app.h"

namespace fwapp {
void showInspector(App& app, fwui::Rect rect);
}  // namespace fwapp
