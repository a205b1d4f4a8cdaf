/// One live source of bytes: it is opened, read without blocking, and opened again when it breaks.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <waymark/tools/live/inputs/address.hpp>

namespace waymark::live {

class ByteInput {
 public:
  /// Nothing is opened yet. @throws UsageError for a kind that this system does not have
  explicit ByteInput(Address address);
  ~ByteInput();
  ByteInput(const ByteInput&) = delete;
  ByteInput& operator=(const ByteInput&) = delete;

  /// Opens it if it is closed and the pause after the last failure is over. The pause doubles from 0.5 s to
  /// 30 s. @param now_s of a steady clock
  void open_if_due(double now_s);
  /// Reads what there is. @returns the bytes; empty: nothing at the moment
  [[nodiscard]] std::string read(double now_s);

  /// -1: closed
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// A connection that is not established yet waits for writing.
  [[nodiscard]] bool connecting() const { return connecting_; }
  /// It has come to its end and will not come back: a file, or the standard input.
  [[nodiscard]] bool ended() const { return ended_; }
  /// Returns what has happened since the last call, in a sentence; empty: nothing.
  [[nodiscard]] std::string news();
  [[nodiscard]] const Address& address() const { return address_; }

 private:
  void open(double now_s);
  void open_socket();
  void open_serial();
  void open_can();
  void greet();
  void fail(const std::string& what, double now_s);
  [[nodiscard]] std::string as_candump(const char* frame, std::size_t size) const;

  Address address_;
  int descriptor_ = -1;
  bool connecting_ = false;
  bool ended_ = false;
  double due_s_ = 0;
  double pause_s_ = 0.5;
  std::string news_;
};

}  // namespace waymark::live
