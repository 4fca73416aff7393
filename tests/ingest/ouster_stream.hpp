// A recording of a small Ouster in the making.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {

/// 16 columns a frame, packets of 4 columns, 2 beams.
class Stream {
 public:
  explicit Stream(OusterSensor sensor = {})
      : sensor_(std::move(sensor)), pcap_(folder_.path() + "/stream.pcap") {}

  Stream& packet(int frame_id, int first_column, const Sent& sent = {}) {
    pcap_.add(frame(plain_packet(sensor_, frame_id, first_column), sent));
    return *this;
  }
  Stream& whole_frame(int frame_id, const Sent& sent = {}) {
    for (int column = 0; column < sensor_.columns; column += 4) packet(frame_id, column, sent);
    return *this;
  }
  Stream& raw(const ByteVector& bytes, std::size_t missing = 0) {
    pcap_.add(bytes, 0, missing);
    return *this;
  }

  /// Why it can't be opened with the metadata of `sensor`.
  std::string refusal(const OusterSensor& sensor) {
    const std::string meta = write_text(folder_.path() + "/meta.json", sensor.json());
    return open_error("ouster:" + pcap_.write() + "?meta=" + meta);
  }
  std::vector<Sweep> play(double min_fraction = 0.5, std::size_t max_returns = 1000,
                          const std::string& more = "") {
    const std::string meta = write_text(folder_.path() + "/meta.json", sensor_.json());
    source_ = open("ouster:" + pcap_.write() + "?meta=" + meta + more, {min_fraction, max_returns});
    return all_sweeps(*source_);
  }
  [[nodiscard]] const ingest::SourceCounters& counters() const { return source_->counters(); }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return source_->warnings(); }
  [[nodiscard]] const OusterSensor& sensor() const { return sensor_; }

 private:
  TemporaryFolder folder_;
  OusterSensor sensor_;
  PcapWriter pcap_;
  std::unique_ptr<ingest::Source> source_;
};

}  // namespace gvom::test
