#pragma once
// A client of a server of web pages on this machine, byte by byte.

#include <cstdint>
#include <string>

#include "shared/system/descriptor.h"

namespace tenon::tests {

class HttpClient {
 public:
  /// Connects. @throws std::runtime_error where nobody listens
  explicit HttpClient(std::uint16_t port);

  /// All of it, or as much as is taken.
  void send(const std::string& bytes) const;
  /// What comes until the words are among it, the other end closes, or nothing comes for 30 s.
  std::string read_until(const std::string& words);
  /// What comes until the other end closes.
  std::string read_all();

 private:
  [[nodiscard]] bool read_more();

  Descriptor socket_;
  std::string heard_;
};

/// "GET PATH HTTP/1.1" with a Host, that asks to be closed afterwards.
[[nodiscard]] std::string get_request(const std::string& path, const std::string& host,
                                      const std::string& more_headers = "");
/// The answer to a request, whole.
[[nodiscard]] std::string http_answer(std::uint16_t port, const std::string& request);

}  // namespace tenon::tests
