// Glyphs of Material Icons (Google, Apache-2.0), from Debian's fonts-material-design-icons-iconfont
// 6.7.0, named by their use here.
#pragma once

#include <imgui.h>

namespace fwui::icons {

constexpr const char* flame = "\xee\xbd\x95";       // local_fire_department
constexpr const char* brand = "\xee\xa0\x8e";       // whatshot
constexpr const char* select = "\xee\x95\xa9";      // near_me
constexpr const char* move = "\xee\xa2\x9f";        // open_with
constexpr const char* rotate = "\xee\x95\xb7";      // 360
constexpr const char* scale = "\xef\x87\x8e";       // open_in_full
constexpr const char* snap = "\xef\x80\x96";        // grid_4x4
constexpr const char* local = "\xee\xa7\xbe";       // view_in_ar
constexpr const char* srcPoint = "\xee\x8e\x9e";    // adjust
constexpr const char* srcDisc = "\xee\xa0\xb6";     // radio_button_unchecked
constexpr const char* srcLine = "\xef\x84\x88";     // horizontal_rule
constexpr const char* srcJet = "\xee\xa7\xa9";      // stream
constexpr const char* srcRain = "\xee\x8f\xaa";     // grain
constexpr const char* wind = "\xee\xbf\x98";        // air
constexpr const char* water = "\xee\x9e\x98";       // water_drop
constexpr const char* firepit = "\xee\xa9\x83";     // fireplace
constexpr const char* mesh = "\xee\x95\xb4";        // category
constexpr const char* crate = "\xee\x86\xa1";       // inventory_2
constexpr const char* camera = "\xee\x81\x8b";      // videocam
constexpr const char* group = "\xee\x8b\x87";       // folder
constexpr const char* moon = "\xee\xbd\x84";        // bedtime
constexpr const char* sun = "\xee\x90\xb0";         // wb_sunny
constexpr const char* eye = "\xee\xa3\xb4";         // visibility
constexpr const char* eyeOff = "\xee\xa3\xb5";      // visibility_off
constexpr const char* lock = "\xee\xa2\x97";        // lock
constexpr const char* unlock = "\xee\xa2\x98";      // lock_open
constexpr const char* add = "\xee\x85\x85";         // add
constexpr const char* trash = "\xee\xa1\xb2";       // delete
constexpr const char* close = "\xee\x97\x8d";       // close
constexpr const char* check = "\xee\x97\x8a";       // check
constexpr const char* checkOn = "\xee\xa1\xac";     // check_circle
constexpr const char* warn = "\xee\x80\x82";        // warning
constexpr const char* error = "\xee\x80\x80";       // error
constexpr const char* info = "\xee\xa2\x8e";        // info
constexpr const char* down = "\xee\x8c\x93";        // keyboard_arrow_down
constexpr const char* right = "\xee\x8c\x95";       // keyboard_arrow_right
constexpr const char* undo = "\xee\x85\xa6";        // undo
constexpr const char* redo = "\xee\x85\x9a";        // redo
constexpr const char* search = "\xee\xa2\xb6";      // search
constexpr const char* open = "\xee\x8b\x88";        // folder_open
constexpr const char* save = "\xee\x85\xa1";        // save
constexpr const char* newFile = "\xee\xa2\x9c";     // note_add
constexpr const char* history = "\xee\xa2\x89";     // history
constexpr const char* play = "\xee\x80\xb7";        // play_arrow
constexpr const char* pause = "\xee\x80\xb4";       // pause
constexpr const char* toStart = "\xee\x81\x85";     // skip_previous
constexpr const char* toEnd = "\xee\x81\x84";       // skip_next
constexpr const char* stepBack = "\xee\x97\x8b";    // chevron_left
constexpr const char* stepFwd = "\xee\x97\x8c";     // chevron_right
constexpr const char* loop = "\xee\x81\x80";        // repeat
constexpr const char* brush = "\xee\x8e\xae";       // brush
constexpr const char* erase = "\xee\x99\xa5";       // auto_fix_off
constexpr const char* fill = "\xee\x88\xba";        // format_color_fill
constexpr const char* pick = "\xee\x8e\xb8";        // colorize
constexpr const char* smooth = "\xee\x8e\xa5";      // blur_on
constexpr const char* gradient = "\xee\x8f\xa9";    // gradient
constexpr const char* curve = "\xee\x9b\xa1";       // show_chart
constexpr const char* layers = "\xee\x94\xbb";      // layers
constexpr const char* symmetry = "\xee\x8f\xa8";    // flip
constexpr const char* compare = "\xee\x8e\xb9";     // compare
constexpr const char* material = "\xee\x90\xa1";    // texture
constexpr const char* timer = "\xee\x90\xa5";       // timer
constexpr const char* event = "\xee\x85\x93";       // flag
constexpr const char* film = "\xee\xa3\x9a";        // theaters
constexpr const char* exportTo = "\xee\x9a\xb8";    // ios_share
constexpr const char* importFrom = "\xee\x8b\x84";  // file_download
constexpr const char* link = "\xee\x85\x97";        // link
constexpr const char* keyboard = "\xee\x8c\x92";    // keyboard
constexpr const char* frame = "\xee\x8e\xb4";       // center_focus_strong
constexpr const char* pin = "\xef\x84\x8d";         // push_pin
constexpr const char* question = "\xee\xa5\x8c";    // contact_support
constexpr const char* star = "\xee\xa0\xb8";        // star
constexpr const char* tune = "\xee\x90\xa9";        // tune
constexpr const char* bolt = "\xee\xa8\x8b";        // bolt
constexpr const char* copy = "\xee\x85\x8d";        // content_copy
constexpr const char* smear = "\xee\x85\x95";       // gesture

}  // namespace fwui::icons

namespace fwui {

// The font atlas contains only these.
constexpr ImWchar kIconRanges[] = {
    // clang-format off
    0xe000, 0xe000, 0xe002, 0xe002, 0xe034, 0xe034, 0xe037, 0xe037, 0xe040, 0xe040, 0xe044, 0xe044,
    0xe045, 0xe045, 0xe04b, 0xe04b, 0xe145, 0xe145, 0xe14d, 0xe14d, 0xe153, 0xe153, 0xe155, 0xe155,
    0xe157, 0xe157, 0xe15a, 0xe15a, 0xe161, 0xe161, 0xe162, 0xe162, 0xe166, 0xe166, 0xe176, 0xe176,
    0xe1a1, 0xe1a1, 0xe23a, 0xe23a, 0xe2bd, 0xe2bd, 0xe2c4, 0xe2c4, 0xe2c7, 0xe2c7, 0xe2c8, 0xe2c8,
    0xe312, 0xe312, 0xe313, 0xe313, 0xe315, 0xe315, 0xe322, 0xe322, 0xe323, 0xe323, 0xe39e, 0xe39e,
    0xe3a5, 0xe3a5, 0xe3ae, 0xe3ae, 0xe3b4, 0xe3b4, 0xe3b8, 0xe3b8, 0xe3b9, 0xe3b9, 0xe3e8, 0xe3e8,
    0xe3e9, 0xe3e9, 0xe3ea, 0xe3ea, 0xe3ec, 0xe3ec, 0xe3f4, 0xe3f4, 0xe421, 0xe421, 0xe425, 0xe425,
    0xe429, 0xe429, 0xe430, 0xe430, 0xe518, 0xe518, 0xe53b, 0xe53b, 0xe55c, 0xe55c, 0xe569, 0xe569,
    0xe574, 0xe574, 0xe577, 0xe577, 0xe5ca, 0xe5ca, 0xe5cb, 0xe5cb, 0xe5cc, 0xe5cc, 0xe5cd, 0xe5cd,
    0xe5d0, 0xe5d0, 0xe5d4, 0xe5d4, 0xe665, 0xe665, 0xe6b8, 0xe6b8, 0xe6e1, 0xe6e1, 0xe798, 0xe798,
    0xe80b, 0xe80b, 0xe80e, 0xe80e, 0xe836, 0xe836, 0xe838, 0xe838, 0xe86b, 0xe86b, 0xe86c, 0xe86c,
    0xe86f, 0xe86f, 0xe872, 0xe872, 0xe889, 0xe889, 0xe88e, 0xe88e, 0xe897, 0xe897, 0xe898, 0xe898,
    0xe89c, 0xe89c, 0xe89e, 0xe89e, 0xe89f, 0xe89f, 0xe8b6, 0xe8b6, 0xe8b8, 0xe8b8, 0xe8da, 0xe8da,
    0xe8f4, 0xe8f4, 0xe8f5, 0xe8f5, 0xe8fd, 0xe8fd, 0xe945, 0xe945, 0xe94c, 0xe94c, 0xe9e4, 0xe9e4,
    0xe9e9, 0xe9e9, 0xe9fe, 0xe9fe, 0xea0b, 0xea0b, 0xea43, 0xea43, 0xef44, 0xef44, 0xef55, 0xef55,
    0xefd8, 0xefd8, 0xf016, 0xf016, 0xf076, 0xf076, 0xf108, 0xf108, 0xf10d, 0xf10d, 0xf1ce, 0xf1ce,
    0};
// clang-format on

}  // namespace fwui
