#pragma once
// What the programs do about signals, and about the standard streams that they are started with.
// Set-up code; once a program.
//
// Until stop_on_signals(), signals end a program at once as they always do: nothing moves yet, and
// whatever it waits for, a file or a connection, it need not wait on.

#include <atomic>

namespace tenon {

/// From now on every signal that would end the program without its own fault sets `stop`, which
/// outlives the program's work, and ends nothing: SIGINT, SIGTERM, SIGHUP and SIGQUIT, and those
/// that nobody sends but by mistake or from a batch system (SIGUSR1, SIGALRM, SIGXCPU, ...). One
/// that is ignored stays so (nohup). SIGKILL and errors of the program itself end it as ever.
void stop_on_signals(std::atomic<bool>& stop);
/// The same where it matters who means it. @param by_user set by SIGINT and SIGTERM
/// @param by_circumstance by all others: a terminal that is gone has asked for nothing
void stop_on_signals(std::atomic<bool>& by_user, std::atomic<bool>& by_circumstance);

/// After stop_on_signals(), for a program that something in motion waits for: no shell's job
/// control holds it up. SIGTSTP (Ctrl-Z) sets `by_circumstance`, one that is ignored stays so;
/// SIGTTIN and SIGTTOU are ignored: a read from a terminal in whose background it is fails, a write
/// goes through.
void never_be_suspended();

/// A write beyond the limit of a file's size fails like one to a full disk, and ends nothing.
void survive_full_disks();

/// Of descriptors 0, 1 and 2, those that are closed take nothing from now on and give nothing. A
/// bus or a file would get their numbers else, and with them what is printed.
/// @throws InputError where /dev/null cannot be opened
void occupy_standard_streams();

/// All that was printed so far has arrived.
[[nodiscard]] bool output_arrived();
inline constexpr const char* kOutputLost = "standard output could not be written whole";

}  // namespace tenon
