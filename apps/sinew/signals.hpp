// Ctrl-C and SIGTERM, for work that ends early.
#pragma once

namespace sinew::app {

/// From now on the first of them is noted; the second ends the program at once.
void note_signals();

/// Whether there was one since.
bool signalled();

}  // namespace sinew::app
