// Runs the program `sinew` as a user does: its own process, its output caught, a limit on its time, and a folder that
// goes away with the test.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace sinew::test {

using Arguments = std::vector<std::string>;

#if defined(__SANITIZE_ADDRESS__)
inline constexpr double kSlower = 12.0;  ///< the sanitizers' price, for limits on time
#else
inline constexpr double kSlower = 1.0;
#endif

/// How a process ended and what it said.
struct Finished {
  int code = -1;           ///< exit code; -1 if a signal ended it
  int signal = 0;          ///< that ended it; 0 if none
  bool timed_out = false;  ///< it was killed because it took too long
  double seconds = 0.0;
  std::string out, err;
};

/// For the message of a failing test.
inline std::string said(const Finished& done) {
  return "exit code " + std::to_string(done.code) + ", signal " + std::to_string(done.signal) +
         (done.timed_out ? ", TIMED OUT" : "") + "\nstdout: " + done.out.substr(0, 3000) +
         "\nstderr: " + done.err.substr(0, 3000);
}

/// A folder of its own under the system's one for temporary files.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "sinew_apps_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), "mkdtemp");
    path_ = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream out(path, std::ios::binary);
  if (!(out << bytes) || !out.flush()) throw std::runtime_error("cannot write " + path.string());
}

/// The program under test: SINEW_PROGRAM of the environment (to try the tests on a broken one), or the one just built.
inline std::string program() {
  const char* other = std::getenv("SINEW_PROGRAM");
  return other != nullptr ? other : SINEW_PROGRAM;
}

/// A started program. Its two streams go to files without a name, so it never waits for a reader.
class Process {
 public:
  explicit Process(const Arguments& arguments, const std::filesystem::path& working_folder = {})
      : out_(caught()), err_(caught()), start_(std::chrono::steady_clock::now()) {
    Arguments all = {program()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (pid_ == 0) {
      const int nothing = ::open("/dev/null", O_RDONLY);
      ::dup2(nothing, STDIN_FILENO);
      ::dup2(out_, STDOUT_FILENO);
      ::dup2(err_, STDERR_FILENO);
      if (!working_folder.empty() && ::chdir(working_folder.c_str()) != 0) ::_exit(126);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (!ended_) {
      send(SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(out_);
    ::close(err_);
  }

  void send(int signal) const { ::kill(pid_, signal); }

  bool running() {
    if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
    return !ended_;
  }

  /// Waits until it ends, or kills it after `limit` [s].
  Finished wait(double limit) {
    Finished done;
    while (running()) {
      if (!done.timed_out && seconds() > limit) {
        done.timed_out = true;
        send(SIGKILL);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    done.seconds = seconds();
    if (WIFEXITED(status_)) done.code = WEXITSTATUS(status_);
    if (WIFSIGNALED(status_)) done.signal = WTERMSIG(status_);
    done.out = all_of(out_);
    done.err = all_of(err_);
    return done;
  }

 private:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  static int caught() {
    std::string name = (std::filesystem::temp_directory_path() / "sinew_out_XXXXXX").string();
    const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "mkostemp");
    ::unlink(name.c_str());
    return descriptor;
  }
  static std::string all_of(int descriptor) {
    std::string text;
    char buffer[4096];
    for (ssize_t got = 0; (got = ::pread(descriptor, buffer, sizeof buffer, static_cast<off_t>(text.size()))) > 0;)
      text.append(buffer, static_cast<std::size_t>(got));
    return text;
  }

  int out_, err_;
  std::chrono::steady_clock::time_point start_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int status_ = 0;
};

/// Runs the program to its end, at most `limit` seconds (times the sanitizers' price).
inline Finished sinew(const Arguments& arguments, const std::filesystem::path& working_folder = {},
                      double limit = 60.0) {
  return Process(arguments, working_folder).wait(limit * kSlower);
}

/// A crash under the sanitizers is told on stderr; without them it is a signal.
inline bool crashed(const Finished& done) {
  return done.signal != 0 || done.err.find("Sanitizer") != std::string::npos ||
         done.err.find("runtime error:") != std::string::npos;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    lines.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return lines;
}

/// All files below a folder, sorted, relative to it.
inline std::vector<std::string> files_below(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder).generic_string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

inline std::filesystem::path examples() { return std::filesystem::path(SINEW_SOURCE_DIR) / "examples"; }

}  // namespace sinew::test
