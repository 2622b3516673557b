#pragma once
// What the kernel lets through to LCM's sockets. LCM's library puts messages of several datagrams
// (LC03) together, and believes a fragment that says that it begins just below 4 GiB: one such
// datagram, from whoever may send to the group, ended the process. Set-up code.

namespace tenon {

/// From now on the UDP sockets that this process has open take messages of one datagram (LC02)
/// alone, up to 64 kB; those of Tenon have at most a few. After subscribing: LCM's library opens
/// its receiving socket then, and by mpudpm:// more of them later, which this does not reach.
void take_whole_datagrams_only();

}  // namespace tenon
