// libFuzzer target: whatever the bytes, parse_scene returns a scene that can be written and read again, or throws
// InputError with a rule. scripts/fuzz runs it.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "sinew/error/input_error.hpp"
#include "sinew/io/scene_file.hpp"

namespace {

[[noreturn]] void fail(const char* what, const std::string& detail) {
  std::fprintf(stderr, "%s: %s\n", what, detail.c_str());
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    sinew::io::parse_scene(text, "fuzz.yaml", ".");
  } catch (const sinew::InputError& error) {
    if (error.fault().rule.empty()) fail("no rule", error.what());
    if (std::string(error.what()).size() > 2000) fail("long message", error.what());
    return 0;
  }
  const std::string written = sinew::io::parse_scene(text, "fuzz.yaml", ".", {"title=fuzz"}).text;
  try {
    sinew::io::parse_scene(written, "written.yaml", ".");
  } catch (const sinew::InputError& error) {
    fail(error.what(), written);
  }
  return 0;
}
