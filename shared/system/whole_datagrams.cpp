#include "shared/system/whole_datagrams.h"

#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

namespace tenon {
namespace {

constexpr std::uint32_t kUdpHeaderBytes = 8;
constexpr std::uint32_t kLc02 = 0x4C433032;

bool is_udp(int file) {
  int type = 0;
  socklen_t size = sizeof type;
  if (::getsockopt(file, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM)
    return false;
  int domain = 0;
  size = sizeof domain;
  return ::getsockopt(file, SOL_SOCKET, SO_DOMAIN, &domain, &size) == 0 && domain == AF_INET;
}

}  // namespace

void take_whole_datagrams_only() {
  // The datagram's first word, or nothing of it.
  std::array<sock_filter, 4> code = {{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kUdpHeaderBytes),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kLc02, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, 0xFFFFFFFF),
      BPF_STMT(BPF_RET | BPF_K, 0),
  }};
  const sock_fprog program{.len = code.size(), .filter = code.data()};
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", none)) {
    const int file = std::stoi(entry.path().filename().string());
    if (is_udp(file))
      (void)::setsockopt(file, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program);
  }
}

}  // namespace tenon
