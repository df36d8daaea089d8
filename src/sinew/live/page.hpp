// The page itself: HTML, style and script in one, built from viewer/ (see there) and carried by the program.
#pragma once

#include <string>

namespace sinew::live {

const std::string& page();

}  // namespace sinew::live
