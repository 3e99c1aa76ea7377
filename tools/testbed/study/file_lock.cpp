#include "tools/testbed/study/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::string HostName() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

std::string Content(int fd) {
  std::array<char, 512> text{};
  const ssize_t size = ::pread(fd, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : "unknown";
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file)
    : guarded_(file), path_(file.string() + ".lock") {
  while (!TryOnce()) {
  }
}

// False: the holder removed the file between our opening and locking it.
bool FileLock::TryOnce() {
  fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ < 0) {
    throw InputError(
        guarded_.string(), 0, "",
        fmt::format("cannot be written here: {}: {}", path_.string(), std::strerror(errno)));
  }
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    const std::string holder = Content(fd_);
    ::close(fd_);
    throw InputError(guarded_.string(), 0, "",
                     fmt::format("another polnav is writing this file ({}); give each process "
                                 "its own with --out or --shard",
                                 holder));
  }
  struct stat ours {};
  struct stat there {};
  if (::fstat(fd_, &ours) != 0 || ::stat(path_.c_str(), &there) != 0 ||
      ours.st_ino != there.st_ino) {
    ::close(fd_);
    return false;
  }
  const std::string text = fmt::format("process {} on {}", ::getpid(), HostName());
  // Only to tell people; a lock without a name holds as well.
  if (::ftruncate(fd_, 0) == 0) (void)!::write(fd_, text.data(), text.size());
  return true;
}

void FileLock::Forget() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

FileLock::~FileLock() {
  if (fd_ < 0) return;
  ::unlink(path_.c_str());
  ::close(fd_);
}

}  // namespace polnav::testbed
