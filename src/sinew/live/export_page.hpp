// A recorded run as one file that plays without a server.
#pragma once

#include <string>

#include "sinew/live/stage.hpp"

namespace sinew::live {

/// The page with the run in it: its messages one after the other, each behind its length (u32), compressed (gzip), in
/// base64. Of longer runs about `frames` frames, evenly chosen.
std::string standalone_page(Replay& replay, int frames = 600);

}  // namespace sinew::live
