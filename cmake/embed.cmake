# Writes the source of sinew::live::page(): cmake -DPAGE=page.html -DOUT=page.cpp -P embed.cmake
file(READ ${PAGE} bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes "${bytes}")
file(WRITE ${OUT} "// Made of viewer/page.html by cmake/embed.cmake.
#include \"sinew/live/page.hpp\"

namespace sinew::live {

namespace {
constexpr unsigned char kBytes[] = {
${bytes}};
}  // namespace

const std::string& page() {
  static const std::string own(reinterpret_cast<const char*>(kBytes), sizeof kBytes);
  return own;
}

}  // namespace sinew::live
")
