#include "sinew/terminal.hpp"

#include <cerrno>
#include <string>
#include <system_error>

#include "sinew/error/printable.hpp"

namespace sinew::app {

namespace {

int failed = 0;  ///< errno of the first write to standard output that failed

}  // namespace

void write(std::FILE* stream, std::string_view text) {
  const std::string safe = printable(text, true);
  errno = 0;
  if (std::fwrite(safe.data(), 1, safe.size(), stream) < safe.size() && stream == stdout && failed == 0)
    failed = errno == 0 ? EIO : errno;
}

std::string standard_output_failed() {
  errno = 0;
  if (std::fflush(stdout) != 0 && failed == 0) failed = errno == 0 ? EIO : errno;
  return failed == 0 || failed == EPIPE ? std::string() : std::generic_category().message(failed);
}

}  // namespace sinew::app
