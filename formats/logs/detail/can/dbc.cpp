#include <waymark/formats/logs/detail/can/dbc.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/can/dbc_multiplexing.hpp>
#include <waymark/formats/logs/detail/can/dbc_tokens.hpp>

namespace waymark::formats {
namespace {

/// VECTOR__INDEPENDENT_SIG_MSG: here editors put signals that belong to no message.
constexpr std::uint32_t kNoMessage = 0xC000'0000;
/// A double holds all integers up to this one.
constexpr double kMostExact = 9007199254740992.0;
/// The longest message of the transport protocols that DBC files describe (J1939).
constexpr unsigned kMostBytes = 1785;

/// Converts text of an old code page to UTF-8, as far as units need it: degree sign and
/// superscript two.
std::string utf8_unit(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool alone = result.empty() || result.back() != '\xC2';
    if ((c == '\xB0' || c == '\xB2') && alone) result += '\xC2';
    result += c;
  }
  return result;
}

/// Finds the fraction behind a decimal factor and offset, if doubles hold all its integers.
void find_fraction(DbcSignal& signal) {
  if (signal.number == SignalNumber::float32 || signal.number == SignalNumber::float64) return;
  double denominator = 1;
  for (int decimals = 0; decimals <= 15; ++decimals, denominator *= 10) {
    const double numerator = std::round(signal.factor * denominator);
    const double shift = std::round(signal.offset * denominator);
    const double largest = std::ldexp(std::abs(numerator), static_cast<int>(signal.length)) + std::abs(shift);
    if (!(largest < kMostExact)) return;
    if (numerator / denominator != signal.factor || shift / denominator != signal.offset) continue;
    signal.numerator = static_cast<std::int64_t>(numerator);
    signal.shift = static_cast<std::int64_t>(shift);
    signal.denominator = static_cast<std::int64_t>(denominator);
    return;
  }
}

/// Null for an unknown name.
DbcSignal* signal_named(DbcMessage& message, std::string_view name) {
  const auto found = std::find_if(message.signals.begin(), message.signals.end(),
                                  [&](const DbcSignal& signal) { return signal.name == name; });
  return found == message.signals.end() ? nullptr : &*found;
}

class DbcParser {
 public:
  explicit DbcParser(const std::string& path) { dbc_.path = path; }

  Dbc parse(std::string_view text) {
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::size_t end = text.find('\n');
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      read_line(line, number);
    }
    if (dbc_.messages.empty())
      throw InputError(fmt::format("{}: no message (a line 'BO_ ...'): this is no DBC file", dbc_.path));
    for (DbcMessage& message : dbc_.messages) {
      for (DbcSignal& signal : message.signals) find_fraction(signal);
      resolve_multiplexing(message, dbc_.path);
    }
    return std::move(dbc_);
  }

 private:
  struct Place {
    DbcMessage* message = nullptr;
    DbcSignal* signal = nullptr;
  };

  void read_line(std::string_view line, std::size_t number);
  void read_message(DbcTokens& tokens, std::size_t number);
  void read_signal(DbcTokens& tokens, std::size_t number);
  void read_multiplexing(DbcTokens& tokens, DbcSignal& signal);
  void check_fit(const DbcTokens& tokens, DbcSignal& signal) const;
  void read_value_type(DbcTokens& tokens);
  void read_ranges(DbcTokens& tokens);
  Place find_signal(DbcTokens& tokens);

  Dbc dbc_;
  std::unordered_map<std::uint32_t, std::size_t> by_id_;
  std::map<const std::string, std::size_t> by_name_;
  bool in_text_ = false;  ///< within a quoted text that spans lines
  bool in_message_ = false;
  bool passing_over_ = false;  ///< the lines are signals of kNoMessage
};

void DbcParser::read_line(std::string_view line, std::size_t number) {
  const std::size_t first = line.find_first_not_of(" \t");
  const std::string_view body = first == std::string_view::npos ? std::string_view() : line.substr(first);
  DbcTokens tokens(line, number, dbc_.path);
  if (!in_text_ && !body.empty()) {
    const std::string_view keyword = body.substr(0, body.find_first_of(" \t:"));
    if (keyword == "BO_" && body.size() > 3) {
      (void)tokens.name("BO_");
      return read_message(tokens, number);
    }
    if (keyword == "SG_" && body.size() > 3) {
      (void)tokens.name("SG_");
      return passing_over_ ? void() : read_signal(tokens, number);
    }
    if (keyword == "SIG_VALTYPE_" && body.size() > keyword.size()) {
      (void)tokens.name("SIG_VALTYPE_");
      return read_value_type(tokens);
    }
    if (keyword == "SG_MUL_VAL_" && body.size() > keyword.size()) {
      (void)tokens.name("SG_MUL_VAL_");
      return read_ranges(tokens);
    }
    if (body.starts_with("//")) return;
  }
  // A comment (CM_) may span lines that look like signals.
  bool escaped = false;
  for (const char c : line) {
    if (c == '"' && !escaped) in_text_ = !in_text_;
    escaped = c == '\\' && !escaped;
  }
}

void DbcParser::read_message(DbcTokens& tokens, std::size_t number) {
  tokens.set_object("BO_");
  DbcMessage message;
  message.line = number;
  tokens.mark();
  message.id = tokens.number<std::uint32_t>("the message's id");
  message.name = tokens.name("the message's name");
  tokens.set_object("BO_ " + message.name);
  tokens.expect(':');
  message.size = tokens.number<std::uint32_t>("the message's length in bytes");
  in_message_ = true;
  passing_over_ = message.id == kNoMessage;
  if (passing_over_) return;
  const std::uint32_t most = (message.id & kExtendedFrame) != 0 ? 0x9FFF'FFFFU : 0x7FFU;
  if (message.id > most)
    tokens.fail(
        fmt::format("no frame can have the id {}: standard ids are at most 2047; an extended id is "
                    "written with 2147483648 added",
                    message.id));
  if (message.size > kMostBytes)
    tokens.fail(fmt::format("a length of {} bytes is more than a message can have", message.size));
  const auto [same, fresh] = by_id_.emplace(message.id, dbc_.messages.size());
  if (!fresh)
    tokens.fail(fmt::format("the id {} is already used by {} in line {}", message.id,
                            dbc_.messages[same->second].name, dbc_.messages[same->second].line));
  const auto [namesake, new_name] = by_name_.emplace(message.name, dbc_.messages.size());
  if (!new_name)
    tokens.fail(fmt::format("the name is already used by the message in line {}; rename one",
                            dbc_.messages[namesake->second].line));
  constexpr std::uint32_t kNullAddress = 0xFE;
  message.is_group = (message.id & kExtendedFrame) != 0 && (message.id & 0xFFU) == kNullAddress;
  dbc_.messages.push_back(std::move(message));
}

void DbcParser::read_signal(DbcTokens& tokens, std::size_t number) {
  tokens.set_object("SG_");
  DbcSignal signal;
  signal.line = number;
  tokens.mark();
  if (!in_message_) tokens.fail("a signal before the first message (BO_)");
  signal.name = tokens.name("the signal's name");
  tokens.set_object("SG_ " + signal.name);
  DbcSignal* same = signal_named(dbc_.messages.back(), signal.name);
  if (same != nullptr)
    same->trouble = tokens.complaint(fmt::format("{} already has a signal of this name in line {}",
                                                 dbc_.messages.back().name, same->line));
  if (!tokens.accept(':')) {
    read_multiplexing(tokens, signal);
    tokens.expect(':');
  }
  tokens.mark();
  signal.start = tokens.number<unsigned>("the start bit");
  tokens.expect('|');
  signal.length = tokens.number<unsigned>("the length in bits");
  tokens.expect('@');
  const auto order = tokens.number<unsigned>("the byte order 0 (Motorola) or 1 (Intel)");
  if (order > 1)
    tokens.fail(fmt::format("the byte order is {}: it must be 0 (Motorola) or 1 (Intel)", order));
  signal.big_endian = order == 0;
  if (tokens.accept('-')) {
    signal.number = SignalNumber::signed_integer;
  } else if (!tokens.accept('+')) {
    tokens.fail_expected("'+' (unsigned) or '-' (signed)");
  }
  tokens.expect('(');
  signal.factor = tokens.number<double>("the factor");
  tokens.expect(',');
  signal.offset = tokens.number<double>("the offset");
  tokens.expect(')');
  tokens.expect('[');
  (void)tokens.number<double>("the smallest value");
  tokens.expect('|');
  (void)tokens.number<double>("the largest value");
  tokens.expect(']');
  signal.unit = shown_name(utf8_unit(tokens.quoted("the unit in quotes")));
  check_fit(tokens, signal);
  if (same == nullptr) dbc_.messages.back().signals.push_back(std::move(signal));
}

/// "M", "m3" or "m3M" between name and colon.
void DbcParser::read_multiplexing(DbcTokens& tokens, DbcSignal& signal) {
  tokens.mark();
  const std::string word = tokens.name("':' or a multiplexing such as 'M' or 'm3'");
  const char* at = word.data();
  const char* end = at + word.size();
  if (*at == 'm') {
    std::uint64_t when = 0;
    const auto [stop, error] = std::from_chars(at + 1, end, when);
    if (error != std::errc())
      tokens.fail(fmt::format("'{}' is no multiplexing: expected 'M', 'm3' or 'm3M'", word));
    signal.when.push_back({when, when});
    at = stop;
  }
  if (at != end && *at == 'M') {
    signal.multiplexes = true;
    ++at;
  }
  if (at != end) tokens.fail(fmt::format("'{}' is no multiplexing: expected 'M', 'm3' or 'm3M'", word));
}

void DbcParser::check_fit(const DbcTokens& tokens, DbcSignal& signal) const {
  const DbcMessage& message = dbc_.messages.back();
  if (signal.length < 1 || signal.length > 64) {
    signal.trouble =
        tokens.complaint(fmt::format("a length of {} bits: there may be 1 to 64", signal.length));
  } else if (signal.start >= 8 * message.size || signal.bytes_needed() > message.size) {
    // The start is checked first, because bytes_needed() must not overflow.
    signal.trouble = tokens.complaint(
        fmt::format("start {} and length {} do not fit into the {} bytes of {}; correct one of them",
                    signal.start, signal.length, message.size, message.name));
  }
  if (!signal.trouble.empty()) signal.start = signal.length = 1;  // harmless if it is a multiplexer
}

/// Returns the signal that a line names; nulls if the file does not have it.
DbcParser::Place DbcParser::find_signal(DbcTokens& tokens) {
  const auto message = by_id_.find(tokens.number<std::uint32_t>("the message's id"));
  const std::string name = tokens.name("the signal's name");
  if (message == by_id_.end()) return {};
  DbcMessage& found = dbc_.messages[message->second];
  return {&found, signal_named(found, name)};
}

/// "SIG_VALTYPE_ 170 SPEED : 1;": a float (1) or double (2).
void DbcParser::read_value_type(DbcTokens& tokens) {
  tokens.set_object("SIG_VALTYPE_");
  tokens.mark();
  DbcSignal* signal = find_signal(tokens).signal;
  (void)tokens.accept(':');
  const auto type = tokens.number<unsigned>("0 (integer), 1 (float) or 2 (double)");
  if (signal == nullptr || type == 0) return;
  if (type > 2) tokens.fail_expected("0 (integer), 1 (float) or 2 (double)");
  const unsigned length = type == 1 ? 32 : 64;
  if (signal->length != length) {
    signal->trouble = tokens.complaint(fmt::format("{} has {} bits, a {} has {}", signal->name,
                                                   signal->length, type == 1 ? "float" : "double", length));
    return;
  }
  signal->number = type == 1 ? SignalNumber::float32 : SignalNumber::float64;
}

/// "SG_MUL_VAL_ 2024 SPEED PID 13-13, 20-22;": a frame holds SPEED if PID has one of these values.
void DbcParser::read_ranges(DbcTokens& tokens) {
  tokens.set_object("SG_MUL_VAL_");
  const auto [message, signal] = find_signal(tokens);
  tokens.mark();
  const std::string multiplexer = tokens.name("the multiplexer's name");
  std::vector<MultiplexerRange> ranges;
  do {
    MultiplexerRange range;
    range.first = tokens.number<std::uint64_t>("the first value of a range");
    tokens.expect('-');
    range.last = tokens.number<std::uint64_t>("the last value of a range");
    ranges.push_back(range);
  } while (tokens.accept(','));
  if (signal == nullptr) return;
  const DbcSignal* outer = message->find(multiplexer);
  if (outer == nullptr) {
    signal->trouble = tokens.complaint(
        fmt::format("{} has no signal '{}' to multiplex {}", message->name, multiplexer, signal->name));
    return;
  }
  signal->multiplexer = static_cast<std::size_t>(outer - message->signals.data());
  signal->when = std::move(ranges);
}

}  // namespace

Dbc Dbc::parse(std::string_view text, const std::string& path) {
  return DbcParser(path).parse(text);
}

}  // namespace waymark::formats
