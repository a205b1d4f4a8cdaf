#include <waymark/tools/live/inputs/address.hpp>

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>

namespace waymark::live {
namespace {

Address::Kind kind_of(const std::string& scheme, const std::string& text) {
  if (scheme == "tcp") return Address::Kind::tcp;
  if (scheme == "udp") return Address::Kind::udp;
  if (scheme == "gpsd") return Address::Kind::gpsd;
  if (scheme == "serial") return Address::Kind::serial;
  if (scheme == "can") return Address::Kind::can;
  if (scheme == "file") return Address::Kind::file;
  throw UsageError(
      fmt::format("{}: unknown scheme '{}'; known are file, tcp, udp, gpsd, serial, can", text, scheme));
}

void read_options(const std::string& list, Address& address) {
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find('&', begin), list.size());
    const std::string pair = list.substr(begin, end - begin);
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos)
      throw UsageError(address.text + ": an option is written NAME=VALUE, after '?'");
    address.options[pair.substr(0, equals)] = pair.substr(equals + 1);
    begin = end + 1;
  }
}

void read_host(const std::string& authority, Address& address) {
  const std::size_t colon = authority.rfind(':');
  address.host = authority.substr(0, colon);
  if (colon != std::string::npos) address.port = authority.substr(colon + 1);
  const bool digits = std::all_of(address.port.begin(), address.port.end(),
                                  [](unsigned char c) { return std::isdigit(c) != 0; });
  if (!digits || address.port.size() > 5 || (!address.port.empty() && std::stoi(address.port) > 65535))
    throw UsageError(fmt::format("{}: '{}' is no port", address.text, address.port));
}

}  // namespace

Address parse_address(const std::string& text) {
  Address address;
  address.text = text;
  if (text == "-") {
    address.kind = Address::Kind::standard;
    return address;
  }
  const std::size_t scheme = text.find("://");
  const std::size_t query = text.find('?');
  if (query != std::string::npos) read_options(text.substr(query + 1), address);
  if (scheme == std::string::npos) {
    address.path = text.substr(0, query);
    return address;
  }
  address.kind = kind_of(text.substr(0, scheme), text);
  const std::string rest = text.substr(scheme + 3, query == std::string::npos ? query : query - scheme - 3);
  switch (address.kind) {
    case Address::Kind::tcp:
    case Address::Kind::udp:
      read_host(rest, address);
      if (address.port.empty())
        throw UsageError(text + ": the port is missing: tcp://HOST:PORT, udp://HOST:PORT");
      break;
    case Address::Kind::gpsd: {
      const std::size_t slash = std::min(rest.find('/'), rest.size());
      read_host(rest.substr(0, slash), address);
      address.path = rest.substr(slash);
      if (address.host.empty()) address.host = "localhost";
      if (address.port.empty()) address.port = "2947";
      break;
    }
    default:
      address.path = rest;
  }
  if (address.kind == Address::Kind::serial || address.kind == Address::Kind::can ||
      address.kind == Address::Kind::file)
    if (address.path.empty())
      throw UsageError(text + ": the name is missing, as in serial:///dev/ttyACM0 or can://can0");
  return address;
}

}  // namespace waymark::live
