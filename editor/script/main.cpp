// fw-script: runs the editor's scripts without its window.
#include "script/script.h"

int main(int count, char** words) { return fwedit::scriptMain(count, words); }
