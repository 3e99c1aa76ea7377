// Is anybody else writing this file? A lock beside it, FILE.lock, held while the object lives.
//
// flock(2): gone with the process however it ends, and honoured across machines by NFS 4 and the
// usual cluster file systems. The file names who holds it. Processes forked from the holder must
// call Forget, or they would hold it too.
#pragma once

#include <filesystem>

namespace polnav::testbed {

class FileLock {
 public:
  // Throws InputError when another process holds it or the folder cannot be written to.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  // In a child process: lets go of the descriptor, and leaves the lock with the parent.
  void Forget();

 private:
  [[nodiscard]] bool TryOnce();

  std::filesystem::path guarded_;
  std::filesystem::path path_;
  int fd_ = -1;
};

}  // namespace polnav::testbed
