#pragma once
// The other end of slcan over TCP: the virtual arm listens, an executor, tenon-can or any slcan
// program connects. It is a bus: frames of one client reach this end and all other clients.
//
// A client hears and sends frames from O to C, and hears only from L to C. Every line is answered,
// in order, as a Lawicel adapter does:
//
//   | line                | answer                                                              |
//   | O L                 | CR; BEL where the channel is open already                           |
//   | C                   | CR; BEL where it is closed                                          |
//   | S0..S8 sxxyy Z0 Z1  | CR; BEL while the channel is open (there is no bit rate to set, and |
//   |                     | Z1 stamps frames with milliseconds, 0 to 59999)                     |
//   | t r, T R            | z CR, Z CR; BEL where the channel is closed or only listens         |
//   | F                   | Fxx CR, bit 3: frames have been lost since; BEL where it is closed  |
//   | V N                 | V1013 CR, NTENO CR                                                  |
//   | anything else       | BEL                                                                 |
//
// What send() takes leaves at the next flush(), receive() or wait(). Nothing blocks: a client that
// reads too slowly loses frames, which are counted (kQueueFull where no client takes them); one
// that goes away is forgotten. Without a client frames go nowhere, as on a bus without a listener.
// One thread. Owns its sockets.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hw/can/slcan_stream.h"
#include "shared/ports/can_bus.h"
#include "shared/system/descriptor.h"

namespace tenon::hw {

class SlcanServer final : public CanBus {
 public:
  static constexpr std::size_t kMaxClients = 8;

  /// @param listener a listening, non-blocking TCP socket, taken over (see hw/can/endpoints.h)
  explicit SlcanServer(Descriptor listener);
  ~SlcanServer() override;

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void flush() noexcept override;
  void wait(std::int64_t at_most_ns) noexcept override;
  [[nodiscard]] CanBusStatus status() const noexcept override;
  [[nodiscard]] int descriptor() const noexcept override { return sockets_.get(); }

  /// The port that it listens on, also where 0 was asked for.
  [[nodiscard]] std::uint16_t port() const noexcept;
  /// Clients with an open channel.
  [[nodiscard]] std::size_t clients() const noexcept;

 private:
  struct Client {
    enum class Channel : std::uint8_t { kClosed, kOpen, kListening };
    [[nodiscard]] bool hears() const { return stream.is_open() && channel != Channel::kClosed; }

    SlcanStream stream;
    Channel channel = Channel::kClosed;
    bool stamps = false;
    std::uint64_t malformed_answered = 0;
    std::uint64_t lost = 0;       ///< frames that it was too slow for
    std::uint64_t lost_told = 0;  ///< of these and of the stream's, told by F
  };

  [[nodiscard]] bool next_frame(ReceivedFrame& received) noexcept;
  [[nodiscard]] bool poll(std::int64_t at_most_ns) noexcept;
  [[nodiscard]] std::size_t deliver(const CanFrame& frame, const Client* except,
                                    std::size_t& failed) noexcept;
  [[nodiscard]] bool take_frame(Client& client, const CanFrame& frame) noexcept;
  void refuse_malformed(Client& client) noexcept;
  [[nodiscard]] static std::string_view obey(Client& client, std::string_view command) noexcept;
  void accept_client() noexcept;

  void watch(const Descriptor& socket) noexcept;

  Descriptor listener_;
  Descriptor sockets_;  ///< the listener's and all clients', as one
  std::array<Client, kMaxClients> clients_;
  CanBusStatus status_;
};

}  // namespace tenon::hw
