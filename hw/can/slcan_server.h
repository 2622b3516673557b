#pragma once
// The other end of slcan over TCP: the virtual arm listens, an executor, tenon-can or any slcan
// program connects. It is a bus: frames of one client reach this end and all other clients.
//
// As a channel does, a client hears and sends frames from O (or L) to C; other commands are
// answered (V, N, F) or accepted; frames on a closed channel are refused by BEL. Frames that are
// accepted are not answered, which halves the traffic.
//
// What send() takes leaves at the next receive() or wait(). Nothing blocks: a client that reads too
// slowly loses frames (kQueueFull where no client takes them), one that goes away is forgotten.
// Without a client frames go nowhere, as on a bus without a listener. One thread. Owns its sockets.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hw/can/slcan_stream.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class SlcanServer : public CanBus {
 public:
  static constexpr std::size_t kMaxClients = 4;

  /// @param listener a listening, non-blocking TCP socket, taken over (see hw/can/endpoints.h)
  explicit SlcanServer(int listener);
  ~SlcanServer() override;

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void wait(std::int64_t at_most_ns) noexcept override;
  [[nodiscard]] CanBusStatus status() const noexcept override;

  /// The port that it listens on, also where 0 was asked for.
  [[nodiscard]] std::uint16_t port() const noexcept;
  /// Clients with an open channel.
  [[nodiscard]] std::size_t clients() const noexcept;

 private:
  struct Client {
    SlcanStream stream;
    bool channel_open = false;
  };

  [[nodiscard]] bool next_frame(ReceivedFrame& received) noexcept;
  [[nodiscard]] bool poll(std::int64_t at_most_ns) noexcept;
  [[nodiscard]] std::size_t deliver(const CanFrame& frame, const Client* except,
                                    std::size_t& failed) noexcept;
  void obey(Client& client, std::string_view command) noexcept;
  void accept_client() noexcept;
  void flush() noexcept;

  int listener_;
  std::array<Client, kMaxClients> clients_;
  CanBusStatus status_;
};

}  // namespace tenon::hw
