// The recording of a run: one file that only grows, holds every accepted step bit for bit and is readable up to the
// last finished step whatever stopped the run. Tables, ParaView files, pictures and `--resume` are views of it.
//
// Bytes (all numbers little-endian; f64 is IEEE 754 binary64, its bits as they are):
//
//   file    magic     8 bytes  89 53 49 4e 45 57 0d 0a ("\x89SINEW\r\n": a text conversion destroys it)
//           version   u32      7
//           reserved  u32      0
//           record 0           the header
//           record 1, 2, ...   the steps, in order
//
//   record  check     u64      XXH3 64 of all that follows in the record, seeded with the number of the record
//           size      u64      bytes of the payload
//           payload
//
//   header  string program_version, scene_text, scene_name, scene_folder, inputs_hash
//           u64 state_layout, u64 number of signals, string each signal's name
//   step    f64 time, string status, string targets, u32 newton, f64 residual, f64 violation, f64 each signal,
//           u64 number of state entries, f64 each, counts, u64 number of warnings, each of
//   counts  u32 halvings, u32 marks (1 rotated tangent, 2 redundant rows, 4 balanced to rounding, 8 unstable, 16
//   stability
//           known), u32 contacts, f64 penetration, u32 sweeps, u32 Newton iterations of contacts, u32 unsolved
//           problems, f64 complementarity, f64 cone, f64 dissipation
//   warning string code, string where, string message, string remedy, string unit, f64 time, f64 value, f64 limit,
//           u32 steps, u32 latest (0 or 1)
//   string  u64 bytes, then the bytes
//
// Nothing in it depends on the clock or the machine, so equal runs give equal files. A program of another `version`
// refuses the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/io/append_file.hpp"

namespace sinew::io {

inline constexpr std::uint32_t kRecordingVersion = 7;

/// What was run. `inputs_hash` is the content hash of everything the scene reads (io/content_hash).
struct RecordingHeader {
  std::string program_version;
  std::string scene_text;
  std::string scene_name;
  std::string scene_folder;
  std::string inputs_hash;
  std::uint64_t state_layout = 0;         ///< which numbers of a state, in which order (sim/state)
  std::vector<std::string> signal_names;  ///< columns of signals.csv after time, status, newton

  bool operator==(const RecordingHeader&) const = default;
};

/// What a step took, for the sums of a run's report; the meanings are those of `StepReport` and `ContactReport`.
struct StepCounts {
  std::uint32_t halvings = 0;
  bool rotated = false, redundant = false, at_floor = false, unstable = false, stability_known = false;
  std::uint32_t contacts = 0;
  double penetration = 0.0;  ///< [m]
  std::uint32_t sweeps = 0, contact_newton = 0, unsolved = 0;
  double complementarity = 0.0, cone = 0.0, dissipation = 0.0;  ///< [-]

  bool operator==(const StepCounts&) const = default;
};

/// One accepted step; the first is the state at t = 0.
struct RecordedStep {
  double time = 0.0;            ///< [s]
  std::string status;           ///< "converged", ...
  std::string targets;          ///< of an inverse step: "reached", or what is in the way
  std::uint32_t newton = 0;     ///< iterations
  double residual = 0.0;        ///< [-] relative, as the step's report has it
  double violation = 0.0;       ///< [m] largest of the constraints
  std::vector<double> signals;  ///< one per name of the header
  std::vector<double> state;    ///< as many as it has: contacts come and go
  StepCounts counts = {};
  std::vector<Warning> warnings = {};  ///< of this step
};

/// The payload of a step's record, and back again; nothing if it is none with that many signals.
std::string encode(const RecordedStep& step);
std::optional<RecordedStep> decode_step(std::string_view payload, std::size_t signals);

struct Recording {
  RecordingHeader header;
  std::vector<RecordedStep> steps;
  bool torn = false;              ///< something unreadable follows the last step kept here
  std::uint64_t valid_bytes = 0;  ///< of the file up to the end of that step
};

/// Reads a recording step by step, for those that are too large for memory.
class RecordingReader {
 public:
  /// Reads the header. Throws InputError if the file cannot be read, is no recording, is of another version or breaks
  /// off in its header.
  explicit RecordingReader(const std::filesystem::path& path);
  /// The same from a stream of `size` bytes; `file` is named in errors.
  RecordingReader(std::unique_ptr<std::istream> stream, std::uint64_t size, const std::string& file);
  ~RecordingReader();
  RecordingReader(RecordingReader&&) noexcept;
  RecordingReader& operator=(RecordingReader&&) noexcept;

  const RecordingHeader& header() const { return header_; }
  /// The next step, or nothing after the last whole one.
  std::optional<RecordedStep> next();
  bool torn() const { return torn_; }                         ///< something unreadable follows the last one
  std::uint64_t valid_bytes() const { return valid_bytes_; }  ///< of the file up to the end of the last one

 private:
  class Records;
  std::unique_ptr<std::istream> stream_;
  std::unique_ptr<Records> records_;
  RecordingHeader header_;
  bool torn_ = false;
  std::uint64_t size_ = 0, valid_bytes_ = 0;
};

/// Reads all whole records; stops at the first that is torn or damaged. Throws InputError if the file cannot be read,
/// is no recording, is of another version or breaks off in its header.
Recording read_recording(const std::filesystem::path& path);
Recording read_recording(RecordingReader reader);

/// The same, but keeps only the first step and the last; `count` is that of all.
struct RecordingEnds {
  Recording recording;
  std::uint64_t count = 0;
};
RecordingEnds read_ends(const std::filesystem::path& path);

/// Writes a recording. Each step has reached the operating system when `append` returns, so a killed process loses
/// nothing that was finished (a power cut may). Failing writes throw WriteError and leave what is there readable.
class RecordingWriter {
 public:
  /// A new recording; a file of that name is replaced.
  static RecordingWriter create(const std::filesystem::path& path, const RecordingHeader& header);

  /// Goes on after the last whole step; what is torn or damaged behind it is dropped. InputError as `read_recording`.
  static RecordingWriter append_to(const std::filesystem::path& path);

  /// There must be as many signals as the header names (std::invalid_argument otherwise).
  void append(const RecordedStep& step);

  std::uint64_t steps() const { return records_ - 1; }  ///< in the file so far

 private:
  RecordingWriter(AppendFile file, std::size_t signals, std::uint64_t records)
      : file_(std::move(file)), signals_(signals), records_(records) {}

  AppendFile file_;
  std::size_t signals_;
  std::uint64_t records_;  ///< header and steps
};

}  // namespace sinew::io
