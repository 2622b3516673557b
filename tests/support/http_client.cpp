#include "tests/support/http_client.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <stdexcept>

namespace tenon::tests {

HttpClient::HttpClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* any = reinterpret_cast<const sockaddr*>(&address);
  if (::connect(socket_.get(), any, sizeof(address)) != 0) {
    throw std::runtime_error("nobody listens on port " + std::to_string(port));
  }
}

void HttpClient::send(const std::string& bytes) const {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count =
        ::send(socket_.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return;
    sent += static_cast<std::size_t>(count);
  }
}

bool HttpClient::read_more() {
  constexpr int kPatience_ms = 30'000;
  pollfd waited{socket_.get(), POLLIN, 0};
  if (::poll(&waited, 1, kPatience_ms) != 1) return false;
  std::array<char, 4096> buffer{};
  const ssize_t count = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
  if (count <= 0) return false;
  heard_.append(buffer.data(), static_cast<std::size_t>(count));
  return true;
}

std::string HttpClient::read_until(const std::string& words) {
  while (heard_.find(words) == std::string::npos && read_more()) {
  }
  return heard_;
}

std::string HttpClient::read_all() {
  while (read_more()) {
  }
  return heard_;
}

std::string get_request(const std::string& path, const std::string& host,
                        const std::string& more_headers) {
  return "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n" + more_headers +
         "\r\n";
}

std::string http_answer(std::uint16_t port, const std::string& request) {
  HttpClient client(port);
  client.send(request);
  return client.read_all();
}

}  // namespace tenon::tests
