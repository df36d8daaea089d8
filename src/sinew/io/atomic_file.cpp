#include "sinew/io/atomic_file.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace sinew::io {

std::filesystem::path partial_path(const std::filesystem::path& path) {
  return path.parent_path() / (path.filename().string() + ".partial");
}

void remove_earlier(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) throw WriteError(fmt::format("cannot replace {}: {}", path.string(), error.message()));
}

void rename_to(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) throw WriteError(fmt::format("cannot write {}: {}", to.string(), error.message()));
}

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), file_(AppendFile(partial_path(path_), AppendFile::Start::empty)) {}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(partial_path(path_), ignored);
}

void AtomicFile::append(std::string_view bytes) {
  constexpr std::size_t kPiece = 1U << 20;
  waiting_.append(bytes);
  if (waiting_.size() < kPiece) return;
  file_->append(waiting_);
  waiting_.clear();
}

void AtomicFile::commit() {
  file_->append(waiting_);
  waiting_.clear();
  rename_to(partial_path(path_), path_);
  file_.reset();
}

}  // namespace sinew::io
