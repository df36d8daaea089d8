// What is sent to a page: a JSON object, and arrays that it names.
//
// Bytes, all little-endian:
//
//   u32 kind      1: scene, 2: frame
//   u32 size      of the JSON text, padded with spaces to a multiple of 8 less 8, so that arrays begin on such one
//   text          its key "arrays" lists {name, type, at, count}: type is f32, f64, i16 or u32, `at` counts bytes
//                 from the end of the text
//   arrays        each padded to a multiple of 8 bytes
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace sinew::live {

enum class Kind : std::uint32_t { scene = 1, frame = 2 };

/// Puts a message together. Memory of an earlier one is used again.
class Message {
 public:
  void begin(Kind kind);
  void add(const std::string& name, std::span<const float> values) {
    add(name, "f32", values.data(), values.size(), 4);
  }
  void add(const std::string& name, std::span<const double> values) {
    add(name, "f64", values.data(), values.size(), 8);
  }
  void add(const std::string& name, std::span<const std::int16_t> values) {
    add(name, "i16", values.data(), values.size(), 2);
  }
  void add(const std::string& name, std::span<const std::uint32_t> values) {
    add(name, "u32", values.data(), values.size(), 4);
  }
  /// All of it; the arrays are added to the head.
  std::string bytes(nlohmann::ordered_json head) const;

 private:
  void add(const std::string& name, const char* type, const void* data, std::size_t count, std::size_t size);

  struct Array {
    std::string name;
    const char* type;
    std::size_t at, count;
  };
  Kind kind_ = Kind::scene;
  std::vector<Array> arrays_;
  std::string data_;
};

}  // namespace sinew::live
