// Names of keys and their commands.
#include "document/keys.h"

#include <gtest/gtest.h>

namespace fw::test::keys_test {
namespace {

TEST(Keys, NamesRoundTrip) {
    for (const char* name : {"A", "Ctrl+S", "Ctrl+Shift+Z", "Shift+[", "]", ",", "Space",
                             "Ctrl+Space", "Num 1", "Shift+F1", "Del", "Ctrl+Plus"}) {
        const auto keys = fwedit::parseKeys(name);
        ASSERT_TRUE(keys) << name;
        EXPECT_EQ(name, fwedit::printKeys(*keys));
    }
}

TEST(Keys, ReservedKeysAreRefused) {
    for (const char* name :
         {"", "Esc", "Enter", "Ctrl+", "Shift", "a", "Ctrl+Ctrl+S", "Shift+Ctrl+S", "F13", "AB"})
        EXPECT_FALSE(fwedit::parseKeys(name)) << name;
    EXPECT_EQ("", fwedit::printKeys({256, false, false}));  // Esc
    EXPECT_EQ("", fwedit::printKeys({340, false, true}));   // Shift alone
    EXPECT_EQ("", fwedit::printKeys({-1, true, false}));
}

TEST(Keys, CommandsOfOnePageCannotShareAKey) {
    const fwedit::KeyUse uses[] = {{"Save", "Ctrl+S", fwedit::kEveryPageOfAScene},
                                   {"Frame selection", "F", 0},
                                   {"Smear", "F", 2},
                                   {"No keys", "", 0}};
    const auto taken = [&](const char* command, const char* keys, int page) -> std::string_view {
        const fwedit::KeyUse* use =
            fwedit::keyConflict(uses, command, *fwedit::parseKeys(keys), page);
        return use ? use->command : "";
    };
    EXPECT_EQ("Save", taken("Scale", "Ctrl+S", 0));
    EXPECT_EQ("Frame selection", taken("Scale", "F", 0));
    EXPECT_EQ("Smear", taken("Blur", "F", 2));
    EXPECT_EQ("", taken("Smooth paint", "F", 1));     // used by another page
    EXPECT_EQ("", taken("Frame selection", "F", 0));  // its own key
    EXPECT_EQ("Frame selection",
              taken("Undo", "F", fwedit::kEveryPage));  // conflicts on every page
    EXPECT_EQ("", taken("Scale", "Shift+F", 0));
}

}  // namespace
}  // namespace fw::test::keys_test
