// libFuzzer target of the recording reader. scripts/fuzz runs it.
#include <xxhash.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>

#include "sinew/error/input_error.hpp"
#include "sinew/io/recording.hpp"

namespace {

std::string little64(std::uint64_t value) {
  std::string bytes;
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
  return bytes;
}

/// Frames pieces of the input (each with a two-byte length) as records with right checksums, so that their payloads
/// reach the decoder.
std::string framed(const std::string& input) {
  std::string file("\x89SINEW\r\n\0\0\0\0\0\0\0\0", 16);
  file[8] = static_cast<char>(sinew::io::kRecordingVersion);
  std::uint64_t number = 0;
  for (std::size_t at = 0; at + 2 <= input.size();) {
    const std::size_t length = static_cast<unsigned char>(input[at]) | static_cast<unsigned char>(input[at + 1]) << 8;
    const std::string payload = input.substr(at + 2, length);
    const std::string checked = little64(payload.size()) + payload;
    file += little64(XXH3_64bits_withSeed(checked.data(), checked.size(), number++)) + checked;
    at += 2 + payload.size();
  }
  return file;
}

void expect(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string input(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string file = data[0] % 2 == 0 ? input : framed(input);
  const auto read = [&file](std::uint64_t bytes) {
    return sinew::io::read_recording({std::make_unique<std::istringstream>(file), bytes, "fuzz"});
  };
  try {
    const auto recording = read(file.size());
    expect(recording.valid_bytes <= file.size());
    expect(recording.torn == (recording.valid_bytes != file.size()));
    for (const auto& step : recording.steps) {
      expect(step.signals.size() == recording.header.signal_names.size());
    }
    const auto whole = read(recording.valid_bytes);  // what it calls whole is whole
    expect(!whole.torn && whole.steps.size() == recording.steps.size());
  } catch (const sinew::InputError&) {
  }
  return 0;
}
