#include "executor/loop/realtime.h"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace tenon::executor {
namespace {

std::string reason() { return std::strerror(errno); }

void touch_stack() {
  constexpr std::size_t kStack_bytes = 256 * 1024;
  constexpr std::size_t kPage_bytes = 4096;
  volatile char stack[kStack_bytes];
  for (std::size_t i = 0; i < kStack_bytes; i += kPage_bytes) stack[i] = 1;
  static_cast<void>(stack[0]);
}

bool scheduled(int priority) {
  sched_param wanted{};
  wanted.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  if (error != 0) {
    errno = error;
    return false;
  }
  int policy = 0;
  sched_param got{};
  return pthread_getschedparam(pthread_self(), &policy, &got) == 0 && policy == SCHED_FIFO &&
         got.sched_priority == priority;
}

bool pinned(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  errno = pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
  return errno == 0;
}

// The request holds as long as the file stays open, so nobody closes it.
bool kept_awake() {
  static const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const std::int32_t latency_us = 0;
  return file >= 0 && write(file, &latency_us, sizeof(latency_us)) == sizeof(latency_us);
}

}  // namespace

std::vector<std::string> enter_realtime(const RealtimeParameters& parameters) {
  std::vector<std::string> missing;
  if (mallopt(M_TRIM_THRESHOLD, -1) != 1 || mallopt(M_MMAP_MAX, 0) != 1) {
    missing.emplace_back("mallopt refused: the heap may give memory back and fault it in again");
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    missing.push_back("memory is not locked: " + reason() +
                      " (needs CAP_IPC_LOCK or 'ulimit -l unlimited')");
  }
  touch_stack();
  if (parameters.cpu >= 0 && !pinned(parameters.cpu)) {
    missing.push_back("not pinned to CPU " + std::to_string(parameters.cpu) + ": " + reason());
  }
  if (!kept_awake()) {
    missing.push_back("/dev/cpu_dma_latency: " + reason() +
                      " (the processor may sleep deeply; needs root)");
  }
  if (!scheduled(parameters.priority)) {
    missing.push_back("no SCHED_FIFO priority " + std::to_string(parameters.priority) + ": " +
                      reason() + " (needs CAP_SYS_NICE or 'ulimit -r')");
  }
  return missing;
}

}  // namespace tenon::executor
