#include "kaustik/view/http_server.h"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <deque>
#include <optional>
#include <string_view>
#include <thread>

#include "kaustik/base/error.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;

/// What a refused client may still send before the connection is cut, so that it can read why.
constexpr size_t most_drained = 4 << 20;
constexpr std::chrono::milliseconds drain_time{1000};
/// Streams of events have a sign of life at least this often, which finds clients that are gone.
constexpr std::chrono::seconds event_pause{10};
/// Between attempts to accept where the system has no more descriptors.
constexpr std::chrono::milliseconds accept_pause{100};

/// Of every answer: nobody else embeds, keeps or guesses at it, and the page loads its own only.
const std::vector<std::pair<std::string, std::string>>& common_headers() {
  static const std::vector<std::pair<std::string, std::string>> headers = {
      {"X-Content-Type-Options", "nosniff"},
      {"Cache-Control", "no-store"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Content-Security-Policy",
       "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; "
       "form-action 'none'; frame-ancestors 'none'"}};
  return headers;
}

/// What connections share.
struct Shared {
  HttpLimits limits;
  HttpHandler handler;
  size_t connections = 0;
};

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Shared& shared)
      : stream_(std::move(socket)), shared_(shared), pause_(stream_.get_executor()) {
    ++shared_.connections;
  }
  ~Connection() { --shared_.connections; }

  void start() { read(); }
  void send(HttpResponse response);
  void begin_stream();
  void queue(std::shared_ptr<const std::string> text);
  /// From any thread.
  template <typename Action>
  void post(Action action) {
    asio::post(stream_.get_executor(), std::move(action));
  }
  bool is_open() const { return is_open_; }

 private:
  using Parser = http::request_parser<http::string_body>;
  void read();
  void read_body();
  void refuse(beast::error_code error);
  void handle();
  void watch_for_end();
  void write_events();
  void keep_alive_events();
  void drain();
  void close();

  beast::tcp_stream stream_;
  Shared& shared_;
  asio::steady_timer pause_;
  beast::flat_buffer buffer_{64 << 10};
  std::optional<Parser> parser_;
  std::atomic<bool> is_open_{true};
  bool keeps_alive_ = false, is_answered_ = false, is_stream_ = false, is_writing_ = false;
  uint64_t requests_ = 0;
  size_t drained_ = 0;
  // Of the answer that is written:
  std::shared_ptr<const std::string> body_;
  std::optional<http::response<http::span_body<const char>>> response_;
  // Of a stream:
  std::deque<std::shared_ptr<const std::string>> events_;
  size_t queued_bytes_ = 0;
};

class Events final : public EventSink {
 public:
  explicit Events(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}
  void send(std::shared_ptr<const std::string> text) override {
    connection_->post([c = connection_, t = std::move(text)]() mutable { c->queue(std::move(t)); });
  }
  bool is_open() const override { return connection_->is_open(); }

 private:
  std::shared_ptr<Connection> connection_;
};

class Reply final : public HttpReply {
 public:
  explicit Reply(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}
  ~Reply() override {
    if (connection_) send(response_of(RequestError(500, "the server gave no answer", "try again")));
  }
  void send(HttpResponse response) override {
    if (!connection_) return;
    Connection* const connection = connection_.get();
    connection->post(
        [c = std::move(connection_), r = std::move(response)]() mutable { c->send(std::move(r)); });
    connection_ = nullptr;
  }
  std::shared_ptr<EventSink> stream() override {
    auto events = std::make_shared<Events>(connection_);
    connection_->post([c = connection_] { c->begin_stream(); });
    connection_ = nullptr;
    return events;
  }
  bool is_open() const override { return connection_ && connection_->is_open(); }

 private:
  std::shared_ptr<Connection> connection_;
};

void Connection::read() {
  parser_.emplace();
  parser_->header_limit(shared_.limits.header_bytes);
  parser_->body_limit(shared_.limits.body_bytes);
  stream_.expires_after(shared_.limits.read_time);
  http::async_read_header(stream_, buffer_, *parser_,
                          [self = shared_from_this()](beast::error_code error, size_t) {
                            error ? self->refuse(error) : self->read_body();
                          });
}

void Connection::read_body() {
  stream_.expires_after(shared_.limits.read_time);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](beast::error_code error, size_t) {
                     error ? self->refuse(error) : self->handle();
                   });
}

void Connection::refuse(beast::error_code error) {
  keeps_alive_ = false;
  if (error == http::error::end_of_stream || error == http::error::partial_message ||
      error.category() != http::make_error_code(http::error::bad_method).category())
    return close();
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return send(response_of(
        RequestError(431, "the request's header is too long", "send less than 16 KiB of it")));
  if (error == http::error::body_limit)
    return send(
        response_of(RequestError(413, "the request's body is too long", "send at most 1 MiB")));
  send(response_of(
      RequestError(400, "the request is no HTTP: " + error.message(), "send HTTP/1.1")));
}

void Connection::handle() {
  Parser::value_type& message = parser_->get();
  HttpRequest request;
  request.method = std::string(message.method_string());
  request.target = std::string(message.target());
  for (const auto& field : message) {
    std::string name(field.name_string());
    for (char& c : name) c = char(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    request.headers.emplace_back(std::move(name), std::string(field.value()));
  }
  request.body = std::move(message.body());
  keeps_alive_ = message.keep_alive();
  is_answered_ = false;
  ++requests_;
  stream_.expires_never();
  watch_for_end();
  auto reply = std::make_shared<Reply>(shared_from_this());
  try {
    shared_.handler(std::move(request), reply);
  } catch (...) {
    reply->send(response_of_current_exception());
  }
}

/// Notices that the client goes while it waits for an answer.
void Connection::watch_for_end() {
  stream_.socket().async_wait(
      tcp::socket::wait_read,
      [self = shared_from_this(), request = requests_](beast::error_code error) {
        if (error || (self->requests_ != request)) return;
        if (self->is_answered_ && !self->is_stream_) return;
        char byte = 0;
        const int handle = self->stream_.socket().native_handle();
        if (::recv(handle, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) self->close();
      });
}

void Connection::send(HttpResponse response) {
  if (!is_open_ || is_stream_) return;
  is_answered_ = true;
  body_ = response.body ? std::move(response.body) : std::make_shared<const std::string>();
  response_.emplace(http::status(response.status), 11);
  auto& message = *response_;
  message.body() = beast::span<const char>(body_->data(), body_->size());
  message.keep_alive(keeps_alive_);
  if (!response.content_type.empty()) message.set(http::field::content_type, response.content_type);
  for (const auto& [name, value] : common_headers()) message.set(name, value);
  for (const auto& [name, value] : response.headers) message.set(name, value);
  // Answers without contents have none by their number; all others tell their length.
  if (response.status != 204) message.content_length(body_->size());
  stream_.expires_after(shared_.limits.write_time);
  http::async_write(stream_, message, [self = shared_from_this()](beast::error_code error, size_t) {
    self->response_.reset();
    self->body_ = nullptr;
    if (error) return self->close();
    self->keeps_alive_ ? self->read() : self->drain();
  });
}

void Connection::begin_stream() {
  if (!is_open_) return;
  is_stream_ = true;
  std::string head =
      "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nConnection: close\r\n"
      "X-Accel-Buffering: no\r\n";
  for (const auto& [name, value] : common_headers()) head += name + ": " + value + "\r\n";
  queue(std::make_shared<const std::string>(head + "\r\n"));
  keep_alive_events();
}

void Connection::keep_alive_events() {
  pause_.expires_after(event_pause);
  pause_.async_wait([self = shared_from_this()](beast::error_code error) {
    if (error || !self->is_open_) return;
    self->queue(std::make_shared<const std::string>(":\n\n"));
    self->keep_alive_events();
  });
}

void Connection::queue(std::shared_ptr<const std::string> text) {
  if (!is_open_) return;
  queued_bytes_ += text->size();
  if (queued_bytes_ > shared_.limits.queued_event_bytes) return close();
  events_.push_back(std::move(text));
  if (!is_writing_) write_events();
}

void Connection::write_events() {
  if (events_.empty()) return;
  is_writing_ = true;
  stream_.expires_after(shared_.limits.write_time);
  asio::async_write(stream_, asio::buffer(*events_.front()),
                    [self = shared_from_this()](beast::error_code error, size_t) {
                      self->is_writing_ = false;
                      if (error) return self->close();
                      if (self->events_.empty()) return;
                      self->queued_bytes_ -= self->events_.front()->size();
                      self->events_.pop_front();
                      self->stream_.expires_never();
                      self->write_events();
                    });
}

/// Says that it is over, and lets the client read that before the connection is cut.
void Connection::drain() {
  beast::error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  buffer_.consume(buffer_.size());
  if (drained_ == 0) stream_.expires_after(drain_time);
  stream_.async_read_some(buffer_.prepare(16 << 10),
                          [self = shared_from_this()](beast::error_code error, size_t count) {
                            self->drained_ += std::max<size_t>(count, 1);
                            error || self->drained_ > most_drained ? self->close() : self->drain();
                          });
}

void Connection::close() {
  if (!is_open_.exchange(false)) return;
  pause_.cancel();
  stream_.close();
}

}  // namespace

struct HttpServer::State {
  explicit State(HttpLimits limits) : acceptor(io), timer(io), accept_timer(io) {
    shared.limits = limits;
  }
  void listen(const std::string& address, uint16_t port);
  void accept();
  void accepted(tcp::socket socket);
  void tick();

  Shared shared;  // Outlives the connections, which the context holds.
  std::function<void()> tick_action;
  std::chrono::milliseconds interval{100};
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::steady_timer timer, accept_timer;
  tcp::endpoint endpoint;
  std::thread thread;
};

void HttpServer::State::listen(const std::string& address, uint16_t port) {
  beast::error_code error;
  const auto ip = asio::ip::make_address(address, error);
  if (error)
    throw Error(ErrorKind::input, fmt::format("'{}' is no address of a machine", address),
                "give one in numbers: 127.0.0.1, ::1, 0.0.0.0 for all");
  endpoint = tcp::endpoint(ip, port);
  const auto check = [&](const char* step) {
    if (!error) return;
    throw Error(
        ErrorKind::system,
        fmt::format("cannot listen to {} port {}: {} ({})", address, port, error.message(), step),
        port == 0 ? "give an address of this machine"
                  : "choose another port, or leave it out for any that is free");
  };
  acceptor.open(endpoint.protocol(), error);
  check("open");
  acceptor.set_option(asio::socket_base::reuse_address(true), error);
  check("option");
  acceptor.bind(endpoint, error);
  check("bind");
  acceptor.listen(asio::socket_base::max_listen_connections, error);
  check("listen");
  endpoint = acceptor.local_endpoint();
}

void HttpServer::State::accept() {
  acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {
      accept_timer.expires_after(accept_pause);
      return accept_timer.async_wait([this](beast::error_code cancelled) {
        if (!cancelled) accept();
      });
    }
    accepted(std::move(socket));
    accept();
  });
}

void HttpServer::State::accepted(tcp::socket socket) {
  beast::error_code ignored;
  if (shared.connections >= shared.limits.connections) {
    constexpr std::string_view busy =
        "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
    socket.non_blocking(true, ignored);
    socket.write_some(asio::buffer(busy.data(), busy.size()), ignored);
    socket.shutdown(tcp::socket::shutdown_both, ignored);
    return;
  }
  socket.set_option(tcp::no_delay(true), ignored);
  std::make_shared<Connection>(std::move(socket), shared)->start();
}

void HttpServer::State::tick() {
  timer.expires_after(interval);
  timer.async_wait([this](beast::error_code cancelled) {
    if (cancelled) return;
    tick_action();
    tick();
  });
}

HttpServer::HttpServer(const std::string& address, uint16_t port, HttpLimits limits)
    : state_(std::make_unique<State>(limits)) {
  state_->listen(address, port);
}

HttpServer::~HttpServer() { stop(); }

uint16_t HttpServer::port() const { return state_->endpoint.port(); }
bool HttpServer::is_local() const { return state_->endpoint.address().is_loopback(); }

void HttpServer::start(HttpHandler handler, std::chrono::milliseconds interval,
                       std::function<void()> tick) {
  state_->shared.handler = std::move(handler);
  state_->interval = interval;
  state_->tick_action = std::move(tick);
  state_->accept();
  state_->tick();
  state_->thread = std::thread([this] { state_->io.run(); });
}

void HttpServer::post(std::function<void()> action) { asio::post(state_->io, std::move(action)); }

void HttpServer::stop() {
  state_->io.stop();
  if (state_->thread.joinable()) state_->thread.join();
  beast::error_code ignored;
  state_->acceptor.close(ignored);
}

}  // namespace kaustik::view
