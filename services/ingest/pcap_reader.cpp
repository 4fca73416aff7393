#include "services/ingest/pcap_reader.hpp"

#include <pcap/pcap.h>

#include <cstdio>
#include <utility>

#include "services/ingest/capture_file.hpp"

namespace gvom::ingest {
namespace {

// With nanosecond precision, tv_usec holds nanoseconds. Times that no int64 of nanoseconds can hold are 0.
std::int64_t capture_time_ns(const pcap_pkthdr& header) {
  const std::int64_t seconds = header.ts.tv_sec;
  const std::int64_t nanoseconds = header.ts.tv_usec;
  const bool sane = seconds >= 0 && seconds < 0x100000000 && nanoseconds >= 0 && nanoseconds < 1'000'000'000;
  return sane ? seconds * 1'000'000'000 + nanoseconds : 0;
}

/// What libpcap says, and what helps against it.
std::string error_of(pcap_t* handle) {
  const std::string text = pcap_geterr(handle);
  if (text.find("of the first interface") == std::string::npos) return text;
  return text +
         ": a capture of interfaces of several kinds; capture on the sensor's interface alone, or make all "
         "frames "
         "of its kind: editcap -F pcap -T ether FILE ONE.pcap";
}

}  // namespace

void PcapReader::Close::operator()(pcap* handle) const {
  pcap_close(handle);
}

PcapReader::PcapReader(std::string path, Handle handle, std::optional<std::uint16_t> port, SourceState& state)
    : path_(std::move(path)),
      handle_(std::move(handle)),
      state_(state),
      parser_(pcap_datalink(handle_.get()), port, state.counters) {}

tl::expected<PcapReader::Handle, std::string> PcapReader::open_handle(const std::string& path) {
  auto file = open_capture_file(path);
  if (!file) return tl::unexpected(file.error());
  char reason[PCAP_ERRBUF_SIZE] = {};
  Handle handle(pcap_fopen_offline_with_tstamp_precision(file->get(), PCAP_TSTAMP_PRECISION_NANO, reason));
  if (!handle) return tl::unexpected(path + ": not a pcap file that can be read: " + reason);
  static_cast<void>(file->release());  // it is the handle's now
  return handle;
}

tl::expected<std::unique_ptr<PcapReader>, std::string> PcapReader::open(const std::string& path,
                                                                        std::optional<std::uint16_t> port,
                                                                        SourceState& state) {
  auto handle = open_handle(path);
  if (!handle) return tl::unexpected(handle.error());
  const int link_type = pcap_datalink(handle->get());
  if (!FrameParser::supports(link_type)) {
    const char* name = pcap_datalink_val_to_name(link_type);
    return tl::unexpected(
        path + ": link type " + (name != nullptr ? name : std::to_string(link_type)) +
        " is not supported (Ethernet, Linux cooked, PPP, raw IP, loopback): capture on the interface "
        "that the sensor is connected to");
  }
  return std::unique_ptr<PcapReader>(new PcapReader(path, std::move(*handle), port, state));
}

tl::expected<PacketEvent, std::string> PcapReader::next(Packet& out, std::chrono::milliseconds) {
  for (;;) {
    pcap_pkthdr* header = nullptr;
    const unsigned char* bytes = nullptr;
    const int found = pcap_next_ex(handle_.get(), &header, &bytes);
    if (found != 1) return end_of_file(found == PCAP_ERROR_BREAK);
    ++records_;
    if (header->caplen < header->len) note_snapped(header->caplen, header->len);
    if (parser_.parse({bytes, header->caplen}, capture_time_ns(*header), out)) return PacketEvent::packet;
  }
}

void PcapReader::warn(Warning kind, const std::string& text) {
  if (warned_[kind]) return;
  warned_[kind] = true;
  state_.warnings.push_back(path_ + ": packet " + std::to_string(records_) + ": " + text);
}

void PcapReader::note_snapped(std::uint32_t captured, std::uint32_t sent) {
  warn(kSnapped, "captured with a snap length, " + std::to_string(captured) + " of " + std::to_string(sent) +
                     " bytes: capture again with -s 0");
}

tl::expected<PacketEvent, std::string> PcapReader::end_of_file(bool clean) {
  parser_.finish();
  if (const std::uint64_t lonely = parser_.lonely_fragments(); lonely > 0)
    warn(kLonely,
         "here the capture ends, and of " + std::to_string(lonely) +
             " datagrams it has the first fragment alone: a filter by port drops the others; capture "
             "with 'udp or (ip[6:2] & 0x1fff != 0) or ip6 proto 44'");
  if (clean) return PacketEvent::end;
  const std::string where = path_ + ": packet " + std::to_string(records_ + 1);
  if (std::feof(pcap_file(handle_.get())) == 0) {
    return tl::unexpected(where + ": " + error_of(handle_.get()));
  }
  ++records_;
  warn(kCut, "cut off by the end of the file; what was before it is used");
  return PacketEvent::end;
}

tl::expected<void, std::string> PcapReader::rewind() {
  auto handle = open_handle(path_);
  if (!handle) return tl::unexpected(handle.error());
  parser_.finish();
  handle_ = std::move(*handle);
  records_ = 0;
  return {};
}

}  // namespace gvom::ingest
