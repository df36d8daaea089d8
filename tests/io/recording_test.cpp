#include "sinew/io/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "sinew/error/input_error.hpp"
#include "sinew/io/content_hash.hpp"

namespace sinew::io {
namespace {

using testing::HasSubstr;
using Limits = std::numeric_limits<double>;

class RecordingFile : public testing::Test {
 protected:
  RecordingFile() {
    char name[] = "/tmp/sinew_recording_XXXXXX";
    folder_ = mkdtemp(name);
    path_ = folder_ / "recording.sinew";
  }
  ~RecordingFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_, path_;
};

RecordingHeader header() {
  return {.program_version = "0.1.0",
          .scene_text = std::string("time: {step: 10 ms}\n# \xc3\xa9 and a zero byte: ") + '\0' + "!\n",
          .scene_name = "finger",
          .scene_folder = "/scenes",
          .inputs_hash = content_hash("inputs"),
          .state_layout = 5,
          .signal_names = {"tip.x", "pull.force"}};
}

RecordedStep step(int k) {
  RecordedStep s;
  s.time = 0.1 * k;
  s.status = k % 2 == 0 ? "converged" : "max_iterations";
  s.targets = k % 3 == 0 ? "" : "limited: actuators.pull: force at most 3 N";
  s.newton = static_cast<std::uint32_t>(k);
  s.residual = 1e-12 / (k + 1);
  s.violation = Limits::denorm_min();
  s.signals = {-0.0, 1.0 / 3.0 + k};
  s.state = {0.0,
             -0.0,
             Limits::denorm_min(),
             -Limits::denorm_min(),
             Limits::max(),
             Limits::lowest(),
             Limits::infinity(),
             std::bit_cast<double>(0x7ff800000000beefULL),
             1.0 + Limits::epsilon() * k};
  s.counts = {.halvings = 1U + static_cast<std::uint32_t>(k),
              .rotated = k % 2 == 0,
              .redundant = k % 3 == 0,
              .at_floor = k % 5 == 0,
              .unstable = k % 2 == 1,
              .stability_known = true,
              .contacts = 7,
              .penetration = 1e-5 / 3.0,
              .sweeps = 11,
              .contact_newton = 13,
              .unsolved = 17,
              .complementarity = 0.1,
              .cone = 0.2,
              .dissipation = 0.3};
  for (int i = 0; i < k % 3; ++i) {
    s.warnings.push_back({.code = "tendon_pushes",
                          .where = "actuators." + std::to_string(i),
                          .message = "pushes",
                          .remedy = "pull",
                          .time = s.time,
                          .value = 1.0 / 3.0,
                          .unit = "N",
                          .steps = 1});
  }
  return s;
}

void write(const std::filesystem::path& path, int steps) {
  auto writer = RecordingWriter::create(path, header());
  for (int k = 0; k < steps; ++k) writer.append(step(k));
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Recording recording_of(const std::string& bytes) {
  return read_recording({std::make_unique<std::istringstream>(bytes), bytes.size(), "test"});
}

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << i;
}

void expect_same(const RecordedStep& a, const RecordedStep& b) {
  expect_same_bits({a.time, a.residual, a.violation}, {b.time, b.residual, b.violation});
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.targets, b.targets);
  EXPECT_EQ(a.newton, b.newton);
  expect_same_bits(a.signals, b.signals);
  expect_same_bits(a.state, b.state);
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.warnings, b.warnings);
}

std::string message_of(const std::string& bytes) {
  try {
    recording_of(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

TEST_F(RecordingFile, comes_back_bit_for_bit) {
  write(path_, 4);
  const Recording recording = read_recording(path_);
  EXPECT_EQ(recording.header, header());
  EXPECT_FALSE(recording.torn);
  EXPECT_EQ(recording.valid_bytes, std::filesystem::file_size(path_));
  ASSERT_EQ(recording.steps.size(), 4u);
  for (int k = 0; k < 4; ++k) expect_same(recording.steps[k], step(k));
}

TEST_F(RecordingFile, has_the_documented_bytes) {
  auto h = header();
  h.program_version = "v";
  h.scene_text = h.scene_name = h.scene_folder = h.inputs_hash = "";
  h.signal_names = {};
  RecordingWriter::create(path_, h).append({.time = -0.0,
                                            .status = "ok",
                                            .targets = "",
                                            .newton = 3,
                                            .residual = 1.0,
                                            .violation = 2.0,
                                            .signals = {},
                                            .state = {0.5},
                                            .counts = {.halvings = 2, .rotated = true, .stability_known = true}});
  const std::string bytes = bytes_of(path_);
  ASSERT_EQ(bytes.size(), 16u + 16 + (9 + 4 * 8 + 16) + 16 + (8 + 10 + 8 + 4 + 8 + 8 + 8 + 8 + 56 + 8));
  EXPECT_EQ(bytes.substr(0, 16), std::string("\x89SINEW\r\n\x07\0\0\0\0\0\0\0", 16));
  EXPECT_EQ(bytes.substr(24, 8), std::string("\x39\0\0\0\0\0\0\0", 8));                  // payload of the header
  EXPECT_EQ(bytes.substr(32, 9), std::string("\x01\0\0\0\0\0\0\0v", 9));                 // program_version
  EXPECT_EQ(bytes.substr(bytes.size() - 126, 8), std::string("\0\0\0\0\0\0\0\x80", 8));  // time
  EXPECT_EQ(bytes.substr(bytes.size() - 118, 10), std::string("\x02\0\0\0\0\0\0\0ok", 10));
  EXPECT_EQ(bytes.substr(bytes.size() - 100, 4), std::string("\x03\0\0\0", 4));
  EXPECT_EQ(bytes.substr(bytes.size() - 72, 8), std::string("\0\0\0\0\0\0\xe0\x3f", 8));
  EXPECT_EQ(bytes.substr(bytes.size() - 64, 8), std::string("\x02\0\0\0\x11\0\0\0", 8));  // halvings, marks
}

TEST_F(RecordingFile, equal_runs_give_equal_bytes) {
  write(path_, 3);
  write(folder_ / "again", 3);
  EXPECT_EQ(bytes_of(path_), bytes_of(folder_ / "again"));
}

TEST_F(RecordingFile, keeps_every_whole_step_wherever_it_is_cut) {
  std::vector<std::uint64_t> ends;  // of the header and of each step
  {
    auto writer = RecordingWriter::create(path_, header());
    ends.push_back(std::filesystem::file_size(path_));
    for (int k = 0; k < 3; ++k) {
      writer.append(step(k));
      ends.push_back(std::filesystem::file_size(path_));  // (it has reached the system)
    }
  }
  const std::string whole = bytes_of(path_);
  ASSERT_EQ(whole.size(), ends.back());
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    const std::string cut = whole.substr(0, length);
    if (length < ends[0]) {
      EXPECT_NE(message_of(cut), "(accepted)") << length;
      continue;
    }
    const Recording recording = recording_of(cut);
    std::size_t steps = 0;
    while (steps + 1 < ends.size() && ends[steps + 1] <= length) ++steps;
    ASSERT_EQ(recording.steps.size(), steps) << length;
    EXPECT_EQ(recording.torn, length != ends[steps]) << length;
    EXPECT_EQ(recording.valid_bytes, ends[steps]) << length;
  }
}

TEST_F(RecordingFile, detects_every_changed_byte) {
  write(path_, 0);
  const std::size_t first = std::filesystem::file_size(path_);
  write(path_, 3);
  const std::string whole = bytes_of(path_);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ change);
      try {
        const Recording recording = recording_of(damaged);
        EXPECT_TRUE(recording.torn) << i;
        ASSERT_LT(recording.steps.size(), 3u) << i;
        EXPECT_LE(recording.valid_bytes, i);
        EXPECT_GE(i, first);
        for (std::size_t k = 0; k < recording.steps.size(); ++k)
          expect_same(recording.steps[k], step(static_cast<int>(k)));
      } catch (const InputError& error) {
        EXPECT_LT(i, first) << error.what();
      }
    }
  }
}

TEST_F(RecordingFile, does_not_take_a_record_out_of_its_place) {
  write(path_, 0);
  const std::size_t first = std::filesystem::file_size(path_);
  write(path_, 1);
  const std::string whole = bytes_of(path_);
  const Recording recording = recording_of(whole + whole.substr(first));
  EXPECT_EQ(recording.steps.size(), 1u);
  EXPECT_TRUE(recording.torn);
}

TEST_F(RecordingFile, goes_on_after_a_torn_tail_as_if_nothing_had_happened) {
  write(path_, 5);
  const std::string whole = bytes_of(path_);
  write(path_, 2);
  const std::size_t two = std::filesystem::file_size(path_);
  for (const std::size_t length : {two, two + 1, two + 15, two + 16, two + 100}) {
    std::ofstream(path_, std::ios::binary) << whole.substr(0, length);
    auto writer = RecordingWriter::append_to(path_);
    EXPECT_EQ(writer.steps(), 2u);
    for (int k = 2; k < 5; ++k) writer.append(step(k));
    EXPECT_EQ(writer.steps(), 5u);
    EXPECT_EQ(bytes_of(path_), whole) << length;
  }
}

TEST_F(RecordingFile, survives_sigkill_up_to_the_last_finished_step) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    auto writer = RecordingWriter::create(path_, header());
    for (int k = 0;; ++k) {
      writer.append(step(k));
      if (k == 50 && ::write(pipe_ends[1], "x", 1) != 1) _exit(1);
    }
  }
  char ready = 0;
  ASSERT_EQ(::read(pipe_ends[0], &ready, 1), 1);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const Recording recording = read_recording(path_);
  ASSERT_GE(recording.steps.size(), 51u);
  for (std::size_t k = 0; k < recording.steps.size(); ++k) expect_same(recording.steps[k], step(static_cast<int>(k)));
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST_F(RecordingFile, a_write_that_fails_says_so_and_leaves_whole_steps) {
  auto writer = RecordingWriter::create(path_, header());
  writer.append(step(0));
  const auto size = std::filesystem::file_size(path_);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = size + 60, .rlim_max = old.rlim_max};  // room for a part of the step
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  try {
    writer.append(step(1));
  } catch (const WriteError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, HasSubstr("cannot write " + path_.string()));
  EXPECT_THAT(message, HasSubstr("File too large"));
  EXPECT_EQ(std::filesystem::file_size(path_), size);
  writer.append(step(1));  // there is room again
  EXPECT_EQ(read_recording(path_).steps.size(), 2u);
}

TEST_F(RecordingFile, refuses_places_that_cannot_be_written) {
  EXPECT_THROW(RecordingWriter::create(folder_ / "no" / "where", header()), WriteError);
  EXPECT_THROW(RecordingWriter::create(folder_, header()), WriteError);
  if (std::filesystem::exists("/dev/full")) {
    try {
      RecordingWriter::create("/dev/full", header());
      ADD_FAILURE();
    } catch (const WriteError& error) {
      EXPECT_THAT(error.what(), HasSubstr("No space left on device"));
    }
  }
}

TEST_F(RecordingFile, has_one_writer_at_a_time) {
  auto writer = RecordingWriter::create(path_, header());
  writer.append(step(0));
  EXPECT_THROW(RecordingWriter::create(path_, header()), WriteError);
  EXPECT_THROW(RecordingWriter::append_to(path_), WriteError);
  EXPECT_EQ(read_recording(path_).steps.size(), 1u);  // reading is free
}

TEST_F(RecordingFile, a_step_must_have_the_signals_of_the_header) {
  auto writer = RecordingWriter::create(path_, header());
  auto s = step(0);
  s.signals.push_back(1);
  EXPECT_THROW(writer.append(s), std::invalid_argument);
  writer.append(step(0));
  EXPECT_EQ(read_recording(path_).steps.size(), 1u);
}

TEST_F(RecordingFile, refuses_what_is_no_recording) {
  EXPECT_THAT(message_of(""), HasSubstr("is empty"));
  EXPECT_THAT(message_of("time,status,newton\n0,converged,1\n"), HasSubstr("is not a Sinew recording"));
  write(path_, 1);
  std::string newer = bytes_of(path_);
  newer[8] = 8;
  EXPECT_THAT(message_of(newer), HasSubstr("has recording format 8, and this program reads format 7"));
  newer[8] = 6;
  EXPECT_THAT(message_of(newer), HasSubstr("has recording format 6, and this program reads format 7"));
  newer[8] = 0;
  EXPECT_THAT(message_of(newer), HasSubstr("damaged"));
  EXPECT_THROW(read_recording(folder_), InputError);
  EXPECT_THROW(read_recording(folder_ / "missing"), InputError);
}

TEST_F(RecordingFile, sizes_that_lie_allocate_nothing) {
  write(path_, 1);
  const std::string whole = bytes_of(path_);
  for (const int byte : {0x11, 0x7f, 0xff}) {
    std::string damaged = whole;
    std::memset(&damaged[24], byte, 8);  // size of the header's payload
    EXPECT_NE(message_of(damaged), "(accepted)");
  }
}

TEST(ContentHash, is_that_of_the_reference_implementation) {
  EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");  // XXH3 128 of nothing
  EXPECT_NE(content_hash("a"), content_hash("b"));
  EXPECT_EQ(content_hash(std::string("a\0b", 3)).size(), 32u);
  EXPECT_NE(content_hash(std::string("a\0b", 3)), content_hash("a"));
}

}  // namespace
}  // namespace sinew::io
