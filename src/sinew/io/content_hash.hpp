// Names a content by its bytes: equal scenes and meshes have equal hashes, on every machine.
#pragma once

#include <string>
#include <string_view>

namespace sinew::io {

/// XXH3 128 of the bytes as 32 lower-case hexadecimal digits, the same as `xxh128sum` prints. It tells contents apart;
/// it does not resist an attacker.
std::string content_hash(std::string_view bytes);

}  // namespace sinew::io
