/// Where lines go: the standard output, a file, TCP clients, or UDP. A reader that is slow never holds up the
/// estimator: what it does not take is dropped for it, whole lines only, and counted.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include <waymark/tools/live/inputs/address.hpp>

namespace waymark::live {

class ByteOutput {
 public:
  /// Opens it; "tcp://:PORT" listens. @param header for each reader
  /// @param may_wait a replay waits for its reader in place of dropping
  /// @throws OutputError if it cannot be opened; UsageError for a kind that takes no output
  ByteOutput(Address address, std::string header, bool may_wait);
  ~ByteOutput();
  ByteOutput(const ByteOutput&) = delete;
  ByteOutput& operator=(const ByteOutput&) = delete;

  /// Changes the header for readers that connect from now on, and for files that are opened again.
  void use_header(std::string header) { header_ = std::move(header); }
  /// Takes lines, and sends what its readers accept.
  void write(const std::string& lines);
  /// Accepts clients, and sends what waits. Call it now and then.
  void work();
  /// Opens a file again, after it was moved away.
  void reopen();
  /// Waits until what waits is sent, for a second at most.
  void flush();

  [[nodiscard]] std::size_t dropped() const { return dropped_; }
  [[nodiscard]] std::size_t clients() const { return clients_.size(); }
  [[nodiscard]] const Address& address() const { return address_; }
  [[nodiscard]] int listener() const { return listener_; }
  /// Returns what has happened since the last call; empty: nothing.
  [[nodiscard]] std::string news();

 private:
  struct Client {
    int descriptor = -1;
    std::string waiting;
    bool is_socket = false;
  };
  void open();
  void listen();
  void connect_udp();
  void send(Client& client);
  void drop(std::size_t client, const std::string& why);

  Address address_;
  std::string header_;
  bool may_wait_;
  int listener_ = -1;
  std::vector<Client> clients_;
  std::size_t dropped_ = 0;
  std::string news_;
};

}  // namespace waymark::live
