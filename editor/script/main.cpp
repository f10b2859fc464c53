// fw-script: the editor's scripts without the editor's window.
#include "script/script.h"

int main(int count, char** words) { return fwedit::scriptMain(count, words); }
