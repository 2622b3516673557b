#include "shared/config/signals.h"

#include <csignal>

namespace tenon {
namespace {

std::atomic<std::atomic<bool>*> asked{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free);
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free);

void ask_to_stop(int /*signal*/) {
  std::atomic<bool>* stop = asked.load(std::memory_order_relaxed);
  if (stop != nullptr) stop->store(true, std::memory_order_relaxed);
}

}  // namespace

void stop_on_signals(std::atomic<bool>& stop) {
  asked.store(&stop, std::memory_order_relaxed);
  struct sigaction action {};
  action.sa_handler = &ask_to_stop;  // no SA_RESTART: a connection that is not made ends too
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    struct sigaction before {};
    (void)::sigaction(signal, &action, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN)
      (void)::sigaction(signal, &before, nullptr);
  }
}

void survive_full_disks() { (void)std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace tenon
