/// Raw measurements and broadcast ephemerides of UBX logs (RXM-RAWX, RXM-SFRBX).
#pragma once

#include <string>

#include <waymark/formats/logs/detail/raw/raw_rows.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_frames.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_messages.hpp>
#include <waymark/formats/logs/detail/ubx/ubx_subframes.hpp>

namespace waymark::formats {

/// A message RXM-RAWX.
struct UbxRawEpoch {
  satellites::RawEpoch epoch;  ///< signals of the first frequency
  std::size_t unused = 0;      ///< other signals, other systems, and those without a valid pseudorange
};

/// Tells what is wrong with the length or the time of a message RXM-RAWX; empty: nothing.
[[nodiscard]] std::string rawx_error(const UbxPayload& payload);
/// Reads a message RXM-RAWX. Precondition: rawx_error is empty.
[[nodiscard]] UbxRawEpoch read_rxm_rawx(const UbxPayload& payload);

/// Decodes the stream sensor with the columns of the plugin gnss_raw. ubx.hpp has the rules.
class UbxRawDecoder final : public UbxFrameDecoder {
 public:
  /// @throws InputError for navigation files that cannot be read
  UbxRawDecoder(const std::string& path, const LogRequest& request)
      : UbxFrameDecoder(path, request), rows_(path, this->request(), data_) {}

 protected:
  void take_frame(const UbxFrame& frame) override;
  void end() override;

 private:
  void take_measurements(const UbxPayload& payload);

  RawRows rows_;
  UbxSubframes subframes_;
  std::size_t without_week_ = 0, unused_ = 0;
};

}  // namespace waymark::formats
