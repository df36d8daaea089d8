// libFuzzer target: whatever the bytes, read_csv gives as many finite numbers for each column, or throws InputError
// with a rule. scripts/fuzz runs it.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "sinew/error/input_error.hpp"
#include "sinew/io/csv_table.hpp"

namespace {

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sinew_table_fuzz_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path, std::ios::binary) << std::string(reinterpret_cast<const char*>(data), size);
  try {
    const auto names = sinew::io::csv_columns(path);
    if (names.empty()) fail("no columns");
    const auto values = sinew::io::read_csv(path, {names.front(), names.back()});
    if (values.size() != 2 || values[0].size() != values[1].size()) fail("columns of other lengths");
    for (const auto& column : values) {
      for (const double value : column) {
        if (!std::isfinite(value)) fail("not a number");
      }
    }
  } catch (const sinew::InputError& error) {
    if (error.fault().rule.empty()) fail("no rule");
  }
  return 0;
}
