#include "sinew/io/recording.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <istream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "sinew/error/input_error.hpp"

namespace sinew::io {
namespace {

constexpr std::string_view kMagic("\x89SINEW\r\n", 8);
constexpr std::size_t kPreamble = 16;  ///< magic, version, reserved
constexpr std::size_t kFrame = 16;     ///< check and size before each payload

template <class Number>
Number little(Number value) {
  if constexpr (std::endian::native == std::endian::little) return value;
  Number swapped = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    swapped = static_cast<Number>(swapped << 8 | (value & 0xff));
    value = static_cast<Number>(value >> 8);
  }
  return swapped;
}

/// Bytes in the making; the number types of the layout and no others.
class Encoder {
 public:
  void u32(std::uint32_t value) { raw(little(value)); }
  void u64(std::uint64_t value) { raw(little(value)); }
  void f64(double value) { u64(std::bit_cast<std::uint64_t>(value)); }
  void string(std::string_view text) {
    u64(text.size());
    bytes_.append(text);
  }
  void doubles(const std::vector<double>& values) {
    bytes_.reserve(bytes_.size() + 8 * values.size());
    for (const double value : values) f64(value);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class Number>
  void raw(Number value) {
    char memory[sizeof(Number)];
    std::memcpy(memory, &value, sizeof(Number));
    bytes_.append(memory, sizeof(Number));
  }
  std::string bytes_;
};

/// Reads what an Encoder wrote. Every size is compared with what is left before anything is allocated; once something
/// does not fit, all further values are zero or empty and `whole` is false.
class Decoder {
 public:
  explicit Decoder(std::string_view bytes) : rest_(bytes) {}

  std::uint32_t u32() { return raw<std::uint32_t>(); }
  std::uint64_t u64() { return raw<std::uint64_t>(); }
  double f64() { return std::bit_cast<double>(u64()); }
  std::string string() {
    const std::uint64_t size = u64();
    return fits(size, 1) ? std::string(take(size)) : std::string();
  }
  std::vector<double> doubles(std::uint64_t count) {
    std::vector<double> values;
    if (!fits(count, 8)) return values;
    values.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) values.push_back(f64());
    return values;
  }
  std::vector<std::string> strings(std::uint64_t count) {
    std::vector<std::string> values;
    if (!fits(count, 8)) return values;  // (each takes 8 bytes at least)
    values.reserve(count);
    for (std::uint64_t i = 0; i < count && fits_; ++i) values.push_back(string());
    return values;
  }
  std::vector<Warning> warnings(std::uint64_t count) {
    std::vector<Warning> values;
    if (!fits(count, 72)) return values;  // (each takes 72 bytes at least)
    for (std::uint64_t i = 0; i < count && fits_; ++i) {
      Warning& own = values.emplace_back();
      for (std::string* text : {&own.code, &own.where, &own.message, &own.remedy, &own.unit}) *text = string();
      for (double* value : {&own.time, &own.value, &own.limit}) *value = f64();
      own.steps = static_cast<long>(u32());
      own.latest = u32() != 0;
    }
    return values;
  }
  bool whole() const { return fits_ && rest_.empty(); }  ///< all read, nothing missing, nothing left

 private:
  bool fits(std::uint64_t count, std::uint64_t bytes_each) {
    if (count > rest_.size() / bytes_each) fits_ = false;
    return fits_;
  }
  std::string_view take(std::uint64_t size) {
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }
  template <class Number>
  Number raw() {
    Number value = 0;
    if (fits(sizeof(Number), 1)) std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
    return little(value);
  }
  std::string_view rest_;
  bool fits_ = true;
};

std::uint64_t check_of(std::string_view checked, std::uint64_t number) {
  return XXH3_64bits_withSeed(checked.data(), checked.size(), number);
}

/// Record `number` with its frame.
std::string framed(std::string_view payload, std::uint64_t number) {
  Encoder checked;
  checked.string(payload);  // (size and payload, as the frame has them)
  Encoder check;
  check.u64(check_of(checked.bytes(), number));
  return check.bytes() + checked.bytes();
}

std::string encode(const RecordingHeader& header) {
  Encoder out;
  for (const std::string* text :
       {&header.program_version, &header.scene_text, &header.scene_name, &header.scene_folder, &header.inputs_hash})
    out.string(*text);
  out.u64(header.state_layout);
  out.u64(header.signal_names.size());
  for (const std::string& name : header.signal_names) out.string(name);
  return out.bytes();
}

enum Mark : std::uint32_t { kRotated = 1, kRedundant = 2, kAtFloor = 4, kUnstable = 8, kStabilityKnown = 16 };

void encode(const StepCounts& counts, Encoder& out) {
  out.u32(counts.halvings);
  out.u32((counts.rotated ? kRotated : 0U) | (counts.redundant ? kRedundant : 0U) | (counts.at_floor ? kAtFloor : 0U) |
          (counts.unstable ? kUnstable : 0U) | (counts.stability_known ? kStabilityKnown : 0U));
  out.u32(counts.contacts);
  out.f64(counts.penetration);
  for (const std::uint32_t count : {counts.sweeps, counts.contact_newton, counts.unsolved}) out.u32(count);
  for (const double left : {counts.complementarity, counts.cone, counts.dissipation}) out.f64(left);
}

StepCounts decode_counts(Decoder& in) {
  StepCounts counts;
  counts.halvings = in.u32();
  const std::uint32_t marks = in.u32();
  counts.rotated = (marks & kRotated) != 0;
  counts.redundant = (marks & kRedundant) != 0;
  counts.at_floor = (marks & kAtFloor) != 0;
  counts.unstable = (marks & kUnstable) != 0;
  counts.stability_known = (marks & kStabilityKnown) != 0;
  counts.contacts = in.u32();
  counts.penetration = in.f64();
  for (std::uint32_t* count : {&counts.sweeps, &counts.contact_newton, &counts.unsolved}) *count = in.u32();
  for (double* left : {&counts.complementarity, &counts.cone, &counts.dissipation}) *left = in.f64();
  return counts;
}

std::optional<RecordingHeader> decode_header(std::string_view payload) {
  Decoder in(payload);
  RecordingHeader header;
  for (std::string* text :
       {&header.program_version, &header.scene_text, &header.scene_name, &header.scene_folder, &header.inputs_hash})
    *text = in.string();
  header.state_layout = in.u64();
  header.signal_names = in.strings(in.u64());
  if (!in.whole()) return std::nullopt;
  return header;
}

}  // namespace

std::string encode(const RecordedStep& step) {
  Encoder out;
  out.f64(step.time);
  out.string(step.status);
  out.string(step.targets);
  out.u32(step.newton);
  out.f64(step.residual);
  out.f64(step.violation);
  out.doubles(step.signals);
  out.u64(step.state.size());
  out.doubles(step.state);
  encode(step.counts, out);
  out.u64(step.warnings.size());
  for (const Warning& own : step.warnings) {
    for (const std::string* text : {&own.code, &own.where, &own.message, &own.remedy, &own.unit}) out.string(*text);
    for (const double value : {own.time, own.value, own.limit}) out.f64(value);
    out.u32(static_cast<std::uint32_t>(own.steps));
    out.u32(own.latest ? 1 : 0);
  }
  return out.bytes();
}

std::optional<RecordedStep> decode_step(std::string_view payload, std::size_t signals) {
  Decoder in(payload);
  RecordedStep step;
  step.time = in.f64();
  step.status = in.string();
  step.targets = in.string();
  step.newton = in.u32();
  step.residual = in.f64();
  step.violation = in.f64();
  step.signals = in.doubles(signals);
  step.state = in.doubles(in.u64());
  step.counts = decode_counts(in);
  step.warnings = in.warnings(in.u64());
  if (!in.whole()) return std::nullopt;
  return step;
}

/// Takes framed records off a stream of known length, one by one.
class RecordingReader::Records {
 public:
  Records(std::istream& stream, std::uint64_t left) : stream_(stream), left_(left) {}

  /// Payload of the next record, valid until the next call; nothing if it is torn or damaged.
  std::optional<std::string_view> next() {
    if (left_ < kFrame) return std::nullopt;
    char check[8];
    if (!stream_.read(check, 8)) return std::nullopt;
    record_.resize(8);
    if (!stream_.read(record_.data(), 8)) return std::nullopt;
    left_ -= kFrame;
    const std::uint64_t size = Decoder(record_).u64();
    if (size > left_) return std::nullopt;
    record_.resize(8 + size);
    if (!stream_.read(record_.data() + 8, static_cast<std::streamsize>(size))) return std::nullopt;
    left_ -= size;
    if (check_of(record_, number_++) != Decoder({check, 8}).u64()) return std::nullopt;
    return std::string_view(record_).substr(8);
  }

  std::uint64_t left() const { return left_; }  ///< [bytes] after the record read last

 private:
  std::istream& stream_;
  std::uint64_t left_;
  std::uint64_t number_ = 0;
  std::string record_;
};

namespace {

InputError refused(const std::string& file, std::string rule, std::string remedy) {
  return InputError(
      {.file = file, .line = 0, .path = "", .value = "", .rule = std::move(rule), .remedy = std::move(remedy)});
}

InputError unreadable(const std::filesystem::path& path, const std::string& reason) {
  return refused(path.string(), "cannot be read: " + reason, "give the output folder of an earlier run");
}

std::unique_ptr<std::istream> opened(const std::filesystem::path& path) {
  errno = 0;
  auto stream = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*stream) throw unreadable(path, std::generic_category().message(errno));
  return stream;
}

std::uint64_t size_of(const std::filesystem::path& path) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) throw unreadable(path, error.message());
  return size;
}

}  // namespace

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : RecordingReader(opened(path), size_of(path), path.string()) {}

RecordingReader::RecordingReader(std::unique_ptr<std::istream> stream, std::uint64_t size, const std::string& file)
    : stream_(std::move(stream)), size_(size) {
  char preamble[kPreamble];
  if (size == 0)
    throw refused(file, "is empty: its run was stopped before it began", "run the scene again, with --force");
  if (size < kPreamble || !stream_->read(preamble, kPreamble) || std::string_view(preamble, 8) != kMagic)
    throw refused(file, "is not a Sinew recording", "give the recording in the output folder of a run");
  Decoder numbers({preamble + 8, 8});
  const std::uint32_t version = numbers.u32(), reserved = numbers.u32();
  const bool newer = version > kRecordingVersion;
  if (!newer && (version == 0 || reserved != 0))
    throw refused(file, "is damaged: there is no such recording format", "run the scene again");
  if (version != kRecordingVersion)
    throw refused(file,
                  fmt::format("has recording format {}, and this program reads format {}", version, kRecordingVersion),
                  newer ? "read it with the newer version of Sinew that wrote it"
                        : "run the scene again, or read it with the older version of Sinew that wrote it");
  records_ = std::make_unique<Records>(*stream_, size - kPreamble);
  const auto header_bytes = records_->next();
  auto header = header_bytes ? decode_header(*header_bytes) : std::nullopt;
  if (!header) throw refused(file, "is damaged or breaks off before the first step", "run the scene again");
  header_ = std::move(*header);
  valid_bytes_ = size - records_->left();
}

RecordingReader::~RecordingReader() = default;
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;

std::optional<RecordedStep> RecordingReader::next() {
  if (torn_ || records_->left() == 0) return std::nullopt;
  const auto bytes = records_->next();
  std::optional<RecordedStep> step = bytes ? decode_step(*bytes, header_.signal_names.size()) : std::nullopt;
  torn_ = !step;
  if (step) valid_bytes_ = size_ - records_->left();
  return step;
}

Recording read_recording(RecordingReader reader) {
  Recording recording{reader.header(), {}};
  while (std::optional<RecordedStep> step = reader.next()) recording.steps.push_back(std::move(*step));
  recording.torn = reader.torn();
  recording.valid_bytes = reader.valid_bytes();
  return recording;
}

Recording read_recording(const std::filesystem::path& path) { return read_recording(RecordingReader(path)); }

RecordingEnds read_ends(const std::filesystem::path& path) {
  RecordingReader reader(path);
  RecordingEnds ends{{reader.header(), {}}};
  while (std::optional<RecordedStep> step = reader.next()) {
    if (ends.count++ >= 2) ends.recording.steps.pop_back();
    ends.recording.steps.push_back(std::move(*step));
  }
  ends.recording.torn = reader.torn();
  ends.recording.valid_bytes = reader.valid_bytes();
  return ends;
}

RecordingWriter RecordingWriter::create(const std::filesystem::path& path, const RecordingHeader& header) {
  Encoder start;
  start.u32(kRecordingVersion);
  start.u32(0);
  AppendFile file(path, AppendFile::Start::empty);
  file.append(std::string(kMagic) + start.bytes() + framed(encode(header), 0));
  return {std::move(file), header.signal_names.size(), 1};
}

RecordingWriter RecordingWriter::append_to(const std::filesystem::path& path) {
  AppendFile file(path, AppendFile::Start::keep);  // (first, so that no other run writes while we read)
  const auto [recording, count] = read_ends(path);
  if (recording.torn) file.truncate(recording.valid_bytes);
  return {std::move(file), recording.header.signal_names.size(), count + 1};
}

void RecordingWriter::append(const RecordedStep& step) {
  if (step.signals.size() != signals_)
    throw std::invalid_argument(
        fmt::format("recorded step has {} signals, its header {}", step.signals.size(), signals_));
  file_.append(framed(encode(step), records_));
  ++records_;
}

}  // namespace sinew::io
