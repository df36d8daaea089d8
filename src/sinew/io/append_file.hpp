// A file that is written while a run goes on and must be whole after any kill: every write goes to the operating system
// at once, and one that fails leaves the file as it was.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sinew::io {

/// A result could not be written: disc full, no permission, file in use. `what()` names the file and the reason.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Creates a folder and those above it; WriteError if that fails.
void create_folder(const std::filesystem::path& folder);

/// Move-only owner of a file open for writing. A second writer of the same file, in this or another process, is
/// refused.
class AppendFile {
 public:
  enum class Start {
    empty,  ///< created, or emptied if there is one
    keep,   ///< there is one; its content stays
  };

  AppendFile(std::filesystem::path path, Start start);
  ~AppendFile();
  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&& other) noexcept;

  /// Adds the bytes at the end. On failure throws WriteError, and none of them stays in the file. A file that was
  /// deleted, moved or replaced in the meantime is a failure.
  void append(std::string_view bytes);

  /// Replaces everything from `offset` <= size() on by `bytes`, in one write.
  void write_at(std::uint64_t offset, std::string_view bytes);

  /// Drops everything from `size` on.
  void truncate(std::uint64_t size);

  std::uint64_t size() const { return size_; }  ///< [bytes]
  const std::filesystem::path& path() const { return path_; }

 private:
  void expect_in_place() const;
  [[noreturn]] void fail(const std::string& what, int error) const;

  std::filesystem::path path_, place_;  ///< as it was given, and absolute
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace sinew::io
