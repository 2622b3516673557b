#pragma once
// Serves a page and the stream of moments to browsers on this machine, by libmicrohttpd and its
// threads: one a connection, bounded in number, in what they hold and in how long they are silent.
// view_request.h says what is answered. Nothing that is asked changes anything. Made, asked for its
// port and ended on one thread; end the log first, or the threads go on waiting for it.

#include <cstdint>
#include <memory>
#include <string>

#include "shared/system/descriptor.h"
#include "sim/view/moment_log.h"

namespace tenon::sim {

class ViewServer {
 public:
  /// @param listener of this machine's own address  @param log outlives this
  /// @throws InputError where no thread can be had
  ViewServer(Descriptor listener, const std::string& page, MomentLog& log);
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;
  ~ViewServer();

  [[nodiscard]] std::uint16_t port() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon::sim
