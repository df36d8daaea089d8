#include "sinew/io/append_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace sinew::io {

void create_folder(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw WriteError(fmt::format("cannot create folder {}: {}", folder.string(), error.message()));
}

AppendFile::AppendFile(std::filesystem::path path, Start start)
    : path_(std::move(path)), place_(std::filesystem::absolute(path_)) {
  const int create = start == Start::empty ? O_CREAT : 0;
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC | create, 0666);
  if (descriptor_ < 0) fail("cannot open", errno);
  try {
    // File systems without locks answer with another error; there we go on without.
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw WriteError(fmt::format("cannot write {}: another run is writing it; wait for it or choose another folder",
                                   path_.string()));
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) fail("cannot open", errno);
    size_ = static_cast<std::uint64_t>(status.st_size);
    if (start == Start::empty && size_ > 0) truncate(0);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

AppendFile::~AppendFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : path_(std::move(other.path_)),
      place_(std::move(other.place_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

AppendFile& AppendFile::operator=(AppendFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(place_, other.place_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

void AppendFile::append(std::string_view bytes) {
  expect_in_place();
  write_at(size_, bytes);
}

void AppendFile::expect_in_place() const {
  struct stat open {
  }, named{};
  if (::fstat(descriptor_, &open) != 0) fail("cannot write", errno);
  if (::stat(place_.c_str(), &named) == 0 && open.st_ino == named.st_ino && open.st_dev == named.st_dev) return;
  throw WriteError(
      fmt::format("cannot write {}: it was deleted, moved or replaced while it was being written", path_.string()));
}

void AppendFile::write_at(std::uint64_t offset, std::string_view bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (written > 0) {
      done += static_cast<std::size_t>(written);
    } else if (written == 0 || errno != EINTR) {
      const int error = written == 0 ? ENOSPC : errno;
      if (::ftruncate(descriptor_, static_cast<off_t>(offset)) == 0) size_ = offset;
      fail("cannot write", error);
    }
  }
  if (offset + bytes.size() < size_)
    truncate(offset + bytes.size());
  else
    size_ = offset + bytes.size();
}

void AppendFile::truncate(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail("cannot shorten", errno);
  size_ = size;
}

void AppendFile::fail(const std::string& what, int error) const {
  throw WriteError(fmt::format("{} {}: {}", what, path_.string(), std::generic_category().message(error)));
}

}  // namespace sinew::io
