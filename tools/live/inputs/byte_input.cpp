#include <waymark/tools/live/inputs/byte_input.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <map>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#if __has_include(<linux/can.h>)
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#define WAYMARK_HAS_SOCKETCAN 1
#endif

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>

namespace waymark::live {
namespace {

constexpr double kFirstPause = 0.5;
constexpr double kLongestPause = 30;
constexpr std::size_t kPiece = 65536;

speed_t baud_of(const Address& address) {
  static const std::map<std::string, speed_t> known{
      {"4800", B4800},     {"9600", B9600},     {"19200", B19200},   {"38400", B38400},  {"57600", B57600},
      {"115200", B115200}, {"230400", B230400}, {"460800", B460800}, {"921600", B921600}};
  const auto stated = address.options.find("baud");
  const auto found = known.find(stated == address.options.end() ? "9600" : stated->second);
  if (found == known.end())
    throw UsageError(
        fmt::format("{}: baud {} is not known; 4800 to 921600 are", address.text, stated->second));
  return found->second;
}

}  // namespace

ByteInput::ByteInput(Address address) : address_(std::move(address)) {
  if (address_.kind == Address::Kind::serial) (void)baud_of(address_);
#ifndef WAYMARK_HAS_SOCKETCAN
  if (address_.kind == Address::Kind::can)
    throw UsageError(address_.text + ": this system has no SocketCAN; pipe candump into '-'");
#endif
}

ByteInput::~ByteInput() {
  if (descriptor_ > 0) ::close(descriptor_);
}

std::string ByteInput::news() {
  return std::exchange(news_, {});
}

void ByteInput::fail(const std::string& what, double now_s) {
  if (descriptor_ > 0) ::close(descriptor_);
  descriptor_ = -1;
  connecting_ = false;
  news_ = fmt::format("{}: {}; next try in {:.1f} s", address_.text, what, pause_s_);
  due_s_ = now_s + pause_s_;
  pause_s_ = std::min(2 * pause_s_, kLongestPause);
}

void ByteInput::open_if_due(double now_s) {
  if (descriptor_ >= 0 || ended_ || now_s < due_s_) return;
  open(now_s);
}

void ByteInput::open(double now_s) {
  errno = 0;
  try {
    switch (address_.kind) {
      case Address::Kind::standard:
        descriptor_ = STDIN_FILENO;
        break;
      case Address::Kind::file:
        descriptor_ = ::open(address_.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        break;
      case Address::Kind::serial:
        open_serial();
        break;
      case Address::Kind::can:
        open_can();
        break;
      default:
        open_socket();
    }
  } catch (const InputError& error) {
    fail(error.what(), now_s);
    return;
  }
  if (descriptor_ < 0) {
    fail(std::strerror(errno), now_s);
    return;
  }
  if (!connecting_) {
    news_ = address_.text + ": open";
    if (address_.kind != Address::Kind::standard) pause_s_ = kFirstPause;
  }
}

void ByteInput::open_socket() {
  const bool datagrams = address_.kind == Address::Kind::udp;
  addrinfo hints{};
  hints.ai_family = datagrams && address_.host.empty() ? AF_INET : AF_UNSPEC;
  hints.ai_socktype = datagrams ? SOCK_DGRAM : SOCK_STREAM;
  hints.ai_flags = datagrams ? AI_PASSIVE : 0;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address_.host.empty() ? nullptr : address_.host.c_str(),
                                address_.port.c_str(), &hints, &found);
  if (error != 0) throw InputError(gai_strerror(error));
  for (const addrinfo* one = found; one != nullptr && descriptor_ < 0; one = one->ai_next) {
    const int made =
        ::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol);
    if (made < 0) continue;
    const int done = datagrams ? ::bind(made, one->ai_addr, one->ai_addrlen)
                               : ::connect(made, one->ai_addr, one->ai_addrlen);
    connecting_ = !datagrams && done != 0 && errno == EINPROGRESS;
    if (done == 0 || connecting_) {
      descriptor_ = made;
    } else {
      const int kept = errno;
      ::close(made);
      errno = kept;
    }
  }
  freeaddrinfo(found);
  if (descriptor_ >= 0 && !connecting_) greet();
}

void ByteInput::open_serial() {
  descriptor_ = ::open(address_.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) return;
  termios line{};
  if (tcgetattr(descriptor_, &line) != 0)
    throw InputError(std::string("no serial line: ") + std::strerror(errno));
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  const speed_t baud = baud_of(address_);
  cfsetispeed(&line, baud);
  cfsetospeed(&line, baud);
  if (tcsetattr(descriptor_, TCSANOW, &line) != 0) throw InputError(std::strerror(errno));
}

void ByteInput::open_can() {
#ifdef WAYMARK_HAS_SOCKETCAN
  descriptor_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor_ < 0) return;
  sockaddr_can to{};
  to.can_family = AF_CAN;
  to.can_ifindex = static_cast<int>(if_nametoindex(address_.path.c_str()));
  if (to.can_ifindex == 0) throw InputError("there is no interface " + address_.path);
  const int yes = 1;
  (void)::setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &yes, sizeof yes);
  if (::bind(descriptor_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    throw InputError(std::strerror(errno));
#endif
}

/// A frame of the interface as the line that `candump -L` writes: the reader is the same.
std::string ByteInput::as_candump([[maybe_unused]] const char* frame,
                                  [[maybe_unused]] std::size_t size) const {
  std::string line;
#ifdef WAYMARK_HAS_SOCKETCAN
  canfd_frame parsed{};
  std::memcpy(&parsed, frame, std::min(size, sizeof parsed));
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const bool is_long = (parsed.can_id & CAN_EFF_FLAG) != 0;
  const unsigned id = parsed.can_id & (is_long ? CAN_EFF_MASK : CAN_SFF_MASK);
  line = fmt::format("({}.{:06}) {} ", now.tv_sec, now.tv_nsec / 1000, address_.path);
  line += is_long ? fmt::format("{:08X}#", id) : fmt::format("{:03X}#", id);
  if (size == sizeof(canfd_frame)) line += fmt::format("#{:X}", parsed.flags & 0xF);
  for (unsigned i = 0; i < std::min<unsigned>(parsed.len, 64); ++i)
    line += fmt::format("{:02X}", parsed.data[i]);
  line += '\n';
#endif
  return line;
}

/// gpsd sends nothing before it is asked.
void ByteInput::greet() {
  connecting_ = false;
  pause_s_ = kFirstPause;
  news_ = address_.text + ": connected";
  if (address_.kind != Address::Kind::gpsd) return;
  const std::string device = address_.path.empty() ? "" : ",\"device\":\"" + address_.path + "\"";
  const std::string watch = "?WATCH={\"enable\":true,\"json\":true" + device + "};\n";
  (void)::send(descriptor_, watch.data(), watch.size(), MSG_NOSIGNAL);
}

std::string ByteInput::read(double now_s) {
  if (descriptor_ < 0) return {};
  if (connecting_) {
    int error = 0;
    socklen_t size = sizeof error;
    (void)::getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) {
      fail(std::strerror(error), now_s);
      return {};
    }
    greet();
    return {};
  }
  std::array<char, kPiece> buffer;
  const ssize_t count = ::read(descriptor_, buffer.data(), buffer.size());
  if (count > 0) {
    const auto size = static_cast<std::size_t>(count);
    return address_.kind == Address::Kind::can ? as_candump(buffer.data(), size)
                                               : std::string(buffer.data(), size);
  }
  if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return {};
  if (count < 0) {
    fail(std::strerror(errno), now_s);
    return {};
  }
  struct stat about {};
  const bool is_pipe = ::fstat(descriptor_, &about) == 0 && S_ISFIFO(about.st_mode);
  const bool ends =
      address_.kind == Address::Kind::standard || (address_.kind == Address::Kind::file && !is_pipe);
  if (ends) {
    ended_ = true;
    if (descriptor_ > 0) ::close(descriptor_);
    descriptor_ = -1;
    news_ = address_.text + ": ended";
  } else if (is_pipe) {
    fail("nobody writes into the pipe", now_s);
    news_.clear();
  } else {
    fail("closed by the other side", now_s);
  }
  return {};
}

}  // namespace waymark::live
