#include <waymark/tools/live/outputs/byte_output.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>

namespace waymark::live {
namespace {

constexpr std::size_t kBytesKept = 1U << 20U;  // bytes for one reader
constexpr std::size_t kMostClients = 64;
constexpr std::size_t kAtomic = 4096;  // a pipe that accepts anything accepts this much

[[noreturn]] void cannot(const Address& address, const std::string& what) {
  throw OutputError(address.text + ": cannot write: " + what);
}

}  // namespace

ByteOutput::ByteOutput(Address address, std::string header, bool may_wait)
    : address_(std::move(address)), header_(std::move(header)), may_wait_(may_wait) {
  open();
}

ByteOutput::~ByteOutput() {
  for (const Client& client : clients_)
    if (client.descriptor > STDERR_FILENO) ::close(client.descriptor);
  if (listener_ >= 0) ::close(listener_);
}

std::string ByteOutput::news() {
  return std::exchange(news_, {});
}

void ByteOutput::open() {
  switch (address_.kind) {
    case Address::Kind::standard:
      clients_.push_back({STDOUT_FILENO, header_, false});
      break;
    case Address::Kind::file: {
      const int made = ::open(address_.path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
      if (made < 0) cannot(address_, std::strerror(errno));
      clients_.push_back({made, header_, false});
      break;
    }
    case Address::Kind::tcp:
      listen();
      break;
    case Address::Kind::udp:
      connect_udp();
      break;
    default:
      throw UsageError(address_.text +
                       ": no output goes there; take -, a file, tcp://:PORT or udp://HOST:PORT");
  }
}

void ByteOutput::listen() {
  addrinfo hints{};
  hints.ai_family = address_.host.empty() ? AF_INET6 : AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  const auto look_up = [&] {
    return getaddrinfo(address_.host.empty() ? nullptr : address_.host.c_str(), address_.port.c_str(), &hints,
                       &found);
  };
  int error = look_up();
  if (error != 0) cannot(address_, gai_strerror(error));
  std::string reason = "no address";
  for (int attempt = 0; attempt < 2 && listener_ < 0; ++attempt) {
    for (const addrinfo* one = found; one != nullptr && listener_ < 0; one = one->ai_next) {
      const int made =
          ::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol);
      const int yes = 1;
      const int no = 0;
      if (made >= 0) (void)::setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      if (made >= 0 && one->ai_family == AF_INET6)
        (void)::setsockopt(made, IPPROTO_IPV6, IPV6_V6ONLY, &no, sizeof no);
      if (made >= 0 && ::bind(made, one->ai_addr, one->ai_addrlen) == 0 && ::listen(made, 8) == 0) {
        listener_ = made;
      } else {
        reason = std::strerror(errno);
        if (made >= 0) ::close(made);
      }
    }
    if (listener_ >= 0 || !address_.host.empty()) break;
    // a machine without IPv6
    freeaddrinfo(found);
    found = nullptr;
    hints.ai_family = AF_INET;
    error = look_up();
    if (error != 0) cannot(address_, gai_strerror(error));
  }
  freeaddrinfo(found);
  if (listener_ < 0) cannot(address_, reason);
}

void ByteOutput::connect_udp() {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address_.host.c_str(), address_.port.c_str(), &hints, &found);
  if (error != 0) cannot(address_, gai_strerror(error));
  const int made =
      ::socket(found->ai_family, found->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, found->ai_protocol);
  const int yes = 1;
  if (made >= 0) (void)::setsockopt(made, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
  const int done = made < 0 ? -1 : ::connect(made, found->ai_addr, found->ai_addrlen);
  freeaddrinfo(found);
  if (done != 0) cannot(address_, std::strerror(errno));
  clients_.push_back({made, {}, true});
}

void ByteOutput::reopen() {
  if (address_.kind != Address::Kind::file) return;
  flush();
  for (const Client& client : clients_) ::close(client.descriptor);
  clients_.clear();
  try {
    open();
  } catch (const OutputError& error) {
    news_ = error.what();
  }
}

void ByteOutput::drop(std::size_t client, const std::string& why) {
  news_ = fmt::format("{}: {}", address_.text, why);
  if (clients_[client].descriptor > STDERR_FILENO) ::close(clients_[client].descriptor);
  clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(client));
}

void ByteOutput::write(const std::string& lines) {
  if (lines.empty()) return;
  if (address_.kind == Address::Kind::udp) {
    // A datagram holds whole lines; who is not there misses it.
    if (!clients_.empty())
      (void)::send(clients_.front().descriptor, lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return;
  }
  const auto is_full = [&](const Client& client) {
    return client.waiting.size() + lines.size() > kBytesKept;
  };
  // It may accept clients and lose some, so it comes before the loop over them.
  if (may_wait_ && std::any_of(clients_.begin(), clients_.end(), is_full)) flush();
  for (Client& client : clients_) {
    if (is_full(client) && !may_wait_) {
      dropped_ += static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n'));
      continue;
    }
    client.waiting += lines;
  }
  work();
}

void ByteOutput::send(Client& client) {
  std::size_t sent = 0;
  while (sent < client.waiting.size()) {
    pollfd ready{client.descriptor, POLLOUT, 0};
    if (::poll(&ready, 1, 0) <= 0) break;
    const char* from = client.waiting.data() + sent;
    const std::size_t left = client.waiting.size() - sent;
    const ssize_t count = client.is_socket
                              ? ::send(client.descriptor, from, left, MSG_NOSIGNAL | MSG_DONTWAIT)
                              : ::write(client.descriptor, from, std::min(left, kAtomic));
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) break;
    if (count <= 0) {
      const int kept = errno;
      client.waiting.clear();
      errno = kept == 0 ? EPIPE : kept;
      throw OutputError(std::strerror(errno));
    }
    sent += static_cast<std::size_t>(count);
  }
  client.waiting.erase(0, sent);
}

void ByteOutput::work() {
  if (listener_ >= 0) {
    for (int made = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC); made >= 0;
         made = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)) {
      if (clients_.size() >= kMostClients) {
        ::close(made);
        continue;
      }
      clients_.push_back({made, header_, true});
      news_ = address_.text + ": a client has connected";
    }
  }
  for (std::size_t i = clients_.size(); i-- > 0;) {
    try {
      send(clients_[i]);
    } catch (const OutputError& error) {
      drop(i, error.what());
    }
  }
}

void ByteOutput::flush() {
  constexpr int kLongest = 100;
  for (int turn = 0; turn < kLongest; ++turn) {
    work();
    const auto waits = [](const Client& client) { return !client.waiting.empty(); };
    const auto one = std::find_if(clients_.begin(), clients_.end(), waits);
    if (one == clients_.end()) return;
    pollfd ready{one->descriptor, POLLOUT, 0};
    (void)::poll(&ready, 1, may_wait_ ? 1000 : 10);
  }
}

}  // namespace waymark::live
