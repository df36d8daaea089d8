// A result that is there whole or not at all: written aside and renamed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "sinew/io/append_file.hpp"

namespace sinew::io {

/// Move-only owner of a file in the making, `<name>.partial` beside the file that it becomes. What is not committed is
/// removed; what a killed program has left of it is overwritten by the next one.
class AtomicFile {
 public:
  /// Throws WriteError if it cannot be made.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(AtomicFile&&) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) = delete;

  /// Adds bytes at the end; they are written in pieces of a megabyte. Throws WriteError.
  void append(std::string_view bytes);

  /// Gives the file its name, in place of any earlier one. Throws WriteError.
  void commit();

 private:
  std::filesystem::path path_;
  std::optional<AppendFile> file_;  ///< until it is committed
  std::string waiting_;
};

/// Where a file or folder of that name is made.
std::filesystem::path partial_path(const std::filesystem::path& path);

/// Removes an earlier file or folder, with all that is in it, if there is one. Throws WriteError.
void remove_earlier(const std::filesystem::path& path);

/// Renames, in place of any earlier file of the new name. Throws WriteError.
void rename_to(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace sinew::io
