#pragma once
// What the programs do about signals. Set-up code; once a program.
//
// Until stop_on_signals(), SIGINT, SIGTERM, SIGHUP and SIGQUIT end a program at once as they always
// do: nothing moves yet, and whatever it waits for, a file or a connection, it need not wait on.

#include <atomic>

namespace tenon {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGQUIT set `stop`, which outlives the program's work,
/// and end nothing. SIGHUP stays ignored where it is (nohup).
void stop_on_signals(std::atomic<bool>& stop);

/// A write beyond the limit of a file's size fails like one to a full disk, and ends nothing.
void survive_full_disks();

}  // namespace tenon
