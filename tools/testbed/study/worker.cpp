#include "tools/testbed/study/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

bool ReadAll(int fd, void* data, std::size_t size) {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t n = ::read(fd, bytes, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool WriteAll(int fd, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(fd, bytes, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

// Processes that the kernel has killed for want of memory, on the whole machine.
std::uint64_t OomKills() {
  std::ifstream stream("/proc/vmstat");
  std::string name;
  std::uint64_t count = 0;
  while (stream >> name >> count) {
    if (name == "oom_kill") return count;
  }
  return 0;
}

// Of what a process allocates for itself: heap, stacks, anonymous maps. Address space would count
// what libraries reserve and never touch.
void LimitMemory(double memory_mb) {
#if !defined(__SANITIZE_ADDRESS__)  // whose shadow of memory is terabytes
  const auto bytes = static_cast<rlim_t>(memory_mb * 1024.0 * 1024.0);
  const rlimit limit{bytes, bytes};
  (void)::setrlimit(RLIMIT_DATA, &limit);
#else
  (void)memory_mb;
#endif
}

}  // namespace

Worker::Worker(const TrialFunction& run, const WorkerLimits& limits,
               const std::function<void()>& in_child)
    : time_limit_s_(limits.time_s), oom_kills_before_(OomKills()) {
  std::array<int, 2> tasks{-1, -1};
  std::array<int, 2> results{-1, -1};
  words_fd_ = ::memfd_create("words", MFD_CLOEXEC);
  const bool piped = words_fd_ >= 0 && ::fcntl(words_fd_, F_SETFL, O_APPEND) == 0 &&
                     ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, tasks.data()) == 0 &&
                     ::pipe2(results.data(), O_CLOEXEC) == 0;
  std::cout.flush();
  std::cerr.flush();
  std::fflush(nullptr);  // or the child would write the same once more
  const pid_t parent = ::getpid();
  pid_ = piped ? ::fork() : -1;
  if (pid_ < 0) {
    throw InputError(fmt::format("a worker process cannot be started: {}", std::strerror(errno)));
  }
  if (pid_ == 0) {
    in_child();
    ::close(tasks[1]);
    ::close(results[0]);
    Serve(run, limits, tasks[0], results[1], parent);
  }
  ::close(tasks[0]);
  ::close(results[1]);
  tasks_fd_ = tasks[1];
  results_fd_ = results[0];
  (void)::fcntl(results_fd_, F_SETFL, O_NONBLOCK);
}

void Worker::Serve(const TrialFunction& run, const WorkerLimits& limits, int tasks_fd,
                   int results_fd, pid_t parent) const {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(0);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(number, SIG_IGN);
  const rlimit no_core{0, 0};
  (void)::setrlimit(RLIMIT_CORE, &no_core);
  LimitMemory(limits.memory_mb);
  ::dup2(words_fd_, STDOUT_FILENO);
  ::dup2(words_fd_, STDERR_FILENO);
  std::uint64_t trial = 0;
  while (ReadAll(tasks_fd, &trial, sizeof(trial))) {
    (void)::ftruncate(words_fd_, 0);
    std::string bytes;
    try {
      bytes = ToCbor(run(trial));
    } catch (const std::bad_alloc&) {
      std::cerr << "std::bad_alloc" << std::endl;
      ::_exit(1);
    } catch (const std::exception& error) {
      std::cerr << error.what() << std::endl;
      ::_exit(1);
    }
    const std::uint64_t size = bytes.size();
    if (!WriteAll(results_fd, &size, sizeof(size)) ||
        !WriteAll(results_fd, bytes.data(), bytes.size())) {
      ::_exit(0);
    }
  }
  ::_exit(0);
}

Worker::~Worker() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    (void)::waitpid(pid_, nullptr, 0);
  }
  for (const int fd : {tasks_fd_, results_fd_, words_fd_}) {
    if (fd >= 0) ::close(fd);
  }
}

void Worker::Start(std::uint64_t trial) {
  trial_ = trial;
  ++trials_started_;
  deadline_ = std::chrono::steady_clock::now() +
              std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                  std::chrono::duration<double>(time_limit_s_));
  // A worker that has died meanwhile is found out when its results are read.
  (void)::send(tasks_fd_, &trial, sizeof(trial), MSG_NOSIGNAL);
}

std::optional<TrialRecord> Worker::Read() {
  std::array<char, 65536> buffer;
  while (true) {
    const ssize_t n = ::read(results_fd_, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) ended_ = true;
    if (n <= 0) break;
    received_.append(buffer.data(), static_cast<std::size_t>(n));
  }
  std::uint64_t size = 0;
  if (received_.size() < sizeof(size)) return std::nullopt;
  std::memcpy(&size, received_.data(), sizeof(size));
  if (received_.size() < sizeof(size) + size) return std::nullopt;
  TrialRecord record = FromCbor(received_.substr(sizeof(size), size));
  received_.erase(0, sizeof(size) + size);
  trial_.reset();
  return record;
}

std::string Worker::LastWords() const {
  std::array<char, 4096> text{};
  const off_t size = ::lseek(words_fd_, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t n = ::pread(words_fd_, text.data(), text.size(), from);
  std::string words(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  while (words.ends_with('\n')) words.pop_back();
  return words;
}

WorkerEnd Worker::Finish() {
  ::kill(pid_, SIGKILL);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  WorkerEnd end;
  const std::string words = LastWords();
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number == SIGKILL) {
    end.out_of_memory = OomKills() > oom_kills_before_;
    end.from_outside = !end.out_of_memory;
    end.detail = end.out_of_memory ? "killed by the kernel: out of memory" : "killed (signal 9)";
    return end;
  }
  end.out_of_memory = words.find("std::bad_alloc") != std::string::npos;
  end.detail = number > 0 ? fmt::format("signal {} ({})", number, ::strsignal(number))
                          : fmt::format("exit code {}", WEXITSTATUS(status));
  if (!words.empty()) end.detail.append(": ").append(words);
  return end;
}

}  // namespace polnav::testbed
