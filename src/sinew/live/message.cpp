#include "sinew/live/message.hpp"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

namespace sinew::live {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

void Message::begin(Kind kind) {
  kind_ = kind;
  arrays_.clear();
  data_.clear();
}

void Message::add(const std::string& name, const char* type, const void* data, std::size_t count, std::size_t size) {
  arrays_.push_back({name, type, data_.size(), count});
  data_.append(static_cast<const char*>(data), count * size);
  data_.resize((data_.size() + 7) / 8 * 8);
}

std::string Message::bytes(nlohmann::ordered_json head) const {
  nlohmann::ordered_json& list = head["arrays"];
  list = nlohmann::ordered_json::array();
  for (const Array& own : arrays_)
    list.push_back({{"name", own.name}, {"type", own.type}, {"at", own.at}, {"count", own.count}});
  std::string text = head.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  text.resize((text.size() + 7) / 8 * 8, ' ');
  const auto kind = static_cast<std::uint32_t>(kind_);
  const auto size = static_cast<std::uint32_t>(text.size());
  std::string all;
  all.reserve(8 + text.size() + data_.size());
  all.append(reinterpret_cast<const char*>(&kind), 4);
  all.append(reinterpret_cast<const char*>(&size), 4);
  all += text;
  all += data_;
  return all;
}

}  // namespace sinew::live
