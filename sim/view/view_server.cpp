#include "sim/view/view_server.h"

#include <fcntl.h>
#include <microhttpd.h>
#include <sys/types.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "shared/base/error.h"
#include "sim/view/loopback.h"
#include "sim/view/view_request.h"

namespace tenon::sim {
namespace {

// Of a request's line and headers, which must fit together, and of what is sent at once.
constexpr std::size_t kConnectionMemory = 32 * 1024;
constexpr unsigned kConnectionsMax = 2 * kViewersMax;
constexpr unsigned kSilence_s = 10;
constexpr std::size_t kBlock = 4096;

/// One viewer's stream: what is left of an event that did not fit.
class Stream {
 public:
  explicit Stream(MomentLog& log) : log_(log) { log_.join(); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() { log_.leave(); }

  /// libmicrohttpd's MHD_ContentReaderCallback.
  static ssize_t read(void* stream, std::uint64_t /*sent*/, char* to, std::size_t most) noexcept {
    return static_cast<Stream*>(stream)->next(to, most);
  }
  static void free(void* stream) noexcept { delete static_cast<Stream*>(stream); }

 private:
  ssize_t next(char* to, std::size_t most) {
    if (at_ == text_.size()) {
      at_ = 0;
      if (!log_.take(viewer_, text_)) return MHD_CONTENT_READER_END_OF_STREAM;
    }
    const std::size_t size = std::min(most, text_.size() - at_);
    std::memcpy(to, text_.data() + at_, size);
    at_ += size;
    return static_cast<ssize_t>(size);
  }

  MomentLog& log_;
  MomentLog::Viewer viewer_;
  std::string text_;
  std::size_t at_ = 0;
};

std::optional<std::string_view> header(MHD_Connection* connection, const char* name) {
  const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
  return value == nullptr ? std::nullopt : std::optional<std::string_view>(value);
}

/// What every answer says besides. None is kept by anybody, or shown inside of another page.
void add_headers(MHD_Response* response, const char* type) {
  const std::pair<const char*, const char*> headers[] = {
      {MHD_HTTP_HEADER_CONTENT_TYPE, type},
      {MHD_HTTP_HEADER_CACHE_CONTROL, "no-store"},
      {"Content-Security-Policy", "frame-ancestors 'none'"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"X-Content-Type-Options", "nosniff"}};
  for (const auto& [name, value] : headers) {
    static_cast<void>(MHD_add_response_header(response, name, value));
  }
}

using Response = std::unique_ptr<MHD_Response, decltype(&MHD_destroy_response)>;

Response response_of(const std::string& text, const char* type) {
  // libmicrohttpd does not write to what it copies.
  Response response(MHD_create_response_from_buffer(text.size(), const_cast<char*>(text.data()),
                                                    MHD_RESPMEM_MUST_COPY),
                    &MHD_destroy_response);
  if (response) add_headers(response.get(), type);
  return response;
}

}  // namespace

class ViewServer::Impl {
 public:
  Impl(Descriptor listener, const std::string& page, MomentLog& log)
      : listener_(std::move(listener)),
        port_(port_of(listener_)),
        page_(response_of(page, "text/html; charset=utf-8")),
        log_(log) {
    // It closes its listener itself, so it gets one of its own.
    const int listening = ::fcntl(listener_.get(), F_DUPFD_CLOEXEC, 0);
    daemon_ = MHD_start_daemon(MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD |
                                   MHD_USE_POLL | MHD_USE_ITC,
                               0, nullptr, nullptr, &Impl::answer, this, MHD_OPTION_LISTEN_SOCKET,
                               listening, MHD_OPTION_CONNECTION_LIMIT, kConnectionsMax,
                               MHD_OPTION_CONNECTION_TIMEOUT, kSilence_s,
                               MHD_OPTION_CONNECTION_MEMORY_LIMIT, kConnectionMemory,
                               MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_END);
    if (daemon_ == nullptr || !page_) {
      throw InputError("--view: the system gives no thread or memory to serve it; leave it out");
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { MHD_stop_daemon(daemon_); }

  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  /// libmicrohttpd's MHD_AccessHandlerCallback: once for the headers, then for what follows them.
  static MHD_Result answer(void* self, MHD_Connection* connection, const char* path,
                           const char* method, const char* /*version*/, const char* /*upload*/,
                           std::size_t* /*upload_size*/, void** seen) noexcept {
    return static_cast<Impl*>(self)->answer_to(connection, path, method, seen);
  }

  MHD_Result answer_to(MHD_Connection* connection, const char* path, const char* method,
                       void** seen) {
    ViewRequest request{method, path, header(connection, MHD_HTTP_HEADER_HOST),
                        header(connection, MHD_HTTP_HEADER_ORIGIN)};
    request.has_body = header(connection, MHD_HTTP_HEADER_CONTENT_LENGTH).value_or("0") != "0" ||
                       header(connection, MHD_HTTP_HEADER_TRANSFER_ENCODING).has_value();
    if (const auto refusal = refuse(request, port_, log_.present())) {
      return turn_away(connection, *refusal);
    }
    // Answered after the headers a connection would be closed; so once more.
    if (*seen == nullptr) {
      *seen = this;
      return MHD_YES;
    }
    if (request.path == "/") return MHD_queue_response(connection, MHD_HTTP_OK, page_.get());
    return stream_to(connection);
  }

  static MHD_Result turn_away(MHD_Connection* connection, const ViewRefusal& refusal) {
    const Response response = response_of(refusal.words, "text/plain; charset=utf-8");
    if (!response) return MHD_NO;
    static_cast<void>(MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CONNECTION, "close"));
    if (refusal.status == MHD_HTTP_METHOD_NOT_ALLOWED) {
      static_cast<void>(MHD_add_response_header(response.get(), MHD_HTTP_HEADER_ALLOW, "GET"));
    }
    return MHD_queue_response(connection, refusal.status, response.get());
  }

  MHD_Result stream_to(MHD_Connection* connection) {
    auto stream = std::make_unique<Stream>(log_);
    const Response response(
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, kBlock, &Stream::read, stream.get(),
                                          &Stream::free),
        &MHD_destroy_response);
    if (!response) return MHD_NO;
    static_cast<void>(stream.release());  // the response's now
    add_headers(response.get(), "text/event-stream");
    return MHD_queue_response(connection, MHD_HTTP_OK, response.get());
  }

  Descriptor listener_;
  std::uint16_t port_;
  Response page_;
  MomentLog& log_;
  MHD_Daemon* daemon_ = nullptr;
};

ViewServer::ViewServer(Descriptor listener, const std::string& page, MomentLog& log)
    : impl_(std::make_unique<Impl>(std::move(listener), page, log)) {}

ViewServer::~ViewServer() = default;

std::uint16_t ViewServer::port() const { return impl_->port(); }

}  // namespace tenon::sim
