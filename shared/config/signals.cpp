#include "shared/config/signals.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "shared/base/error.h"

namespace tenon {
namespace {

std::atomic<std::atomic<bool>*> asked_by_user{nullptr};
std::atomic<std::atomic<bool>*> asked_by_circumstance{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free);
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free);

void ask_to_stop(int signal) {
  const bool by_user = signal == SIGINT || signal == SIGTERM;
  std::atomic<bool>* stop =
      (by_user ? asked_by_user : asked_by_circumstance).load(std::memory_order_relaxed);
  if (stop != nullptr) stop->store(true, std::memory_order_relaxed);
}

void stop_on(int signal) {
  struct sigaction action {};
  action.sa_handler = &ask_to_stop;  // no SA_RESTART: a connection that is not made ends too
  struct sigaction before {};
  (void)::sigaction(signal, nullptr, &before);
  const bool wanted = signal == SIGINT || signal == SIGTERM || signal == SIGQUIT;
  if (wanted || before.sa_handler != SIG_IGN) (void)::sigaction(signal, &action, nullptr);
}

}  // namespace

void stop_on_signals(std::atomic<bool>& stop) { stop_on_signals(stop, stop); }

void stop_on_signals(std::atomic<bool>& by_user, std::atomic<bool>& by_circumstance) {
  asked_by_user.store(&by_user, std::memory_order_relaxed);
  asked_by_circumstance.store(&by_circumstance, std::memory_order_relaxed);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM,
                           SIGPROF, SIGPOLL, SIGPWR, SIGSTKFLT, SIGXCPU}) {
    stop_on(signal);
  }
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) stop_on(signal);
}

void never_be_suspended() {
  stop_on(SIGTSTP);
  (void)std::signal(SIGTTIN, SIG_IGN);
  (void)std::signal(SIGTTOU, SIG_IGN);
}

void survive_full_disks() { (void)std::signal(SIGXFSZ, SIG_IGN); }

void occupy_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // For reading alone: what is printed fails there, and is told as lost. The lowest number that
    // is free is this one.
    if (::open("/dev/null", O_RDONLY) == descriptor) continue;
    throw InputError("a standard stream is closed, and /dev/null cannot be opened in its place: " +
                     std::string(std::strerror(errno)) + "; start it with standard streams");
  }
}

bool output_arrived() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace tenon
