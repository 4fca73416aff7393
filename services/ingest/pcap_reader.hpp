// The UDP payloads of a pcap or pcapng file, also packed by gzip, in the order of capture.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "services/ingest/frames.hpp"
#include "services/ingest/packet.hpp"

struct pcap;

namespace gvom::ingest {

class PcapReader final : public PacketSource {
 public:
  /// With `port`, only payloads to that UDP port. `state` must outlive the reader.
  /// Errors (no such file, not a pcap, a link type that is not supported) name the file.
  static tl::expected<std::unique_ptr<PcapReader>, std::string> open(const std::string& path,
                                                                     std::optional<std::uint16_t> port,
                                                                     SourceState& state);

  /// A last record that is cut off is the end, with a warning; a corrupt one is an error. Packets that were
  /// not captured whole, and fragments whose others were filtered out, are warned of once.
  tl::expected<PacketEvent, std::string> next(Packet& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return false; }

  /// Records read so far, whatever was in them.
  [[nodiscard]] std::uint64_t records() const { return records_; }

 private:
  struct Close {
    void operator()(pcap* handle) const;
  };
  using Handle = std::unique_ptr<pcap, Close>;

  PcapReader(std::string path, Handle handle, std::optional<std::uint16_t> port, SourceState& state);
  static tl::expected<Handle, std::string> open_handle(const std::string& path);
  tl::expected<PacketEvent, std::string> end_of_file(bool clean);
  enum Warning { kCut, kSnapped, kLonely, kWarnings };
  /// With the number of the newest record; of each kind the first only.
  void warn(Warning kind, const std::string& text);
  void note_snapped(std::uint32_t captured, std::uint32_t sent);

  std::string path_;
  Handle handle_;
  SourceState& state_;
  FrameParser parser_;
  std::uint64_t records_ = 0;
  std::array<bool, kWarnings> warned_{};
};

}  // namespace gvom::ingest
