#include "services/common/source_uri.hpp"
#include "tests/ingest/recordings.hpp"

using namespace gvom;
using namespace gvom::ingest;
using gvom::test::open_error;

TEST_CASE("a URI is scheme, path and options") {
  const auto uri = services::parse_source_uri("ouster:/a/b:c.pcap?meta=/x=y.json&port=7502");
  REQUIRE(uri.has_value());
  CHECK(uri->scheme == "ouster");
  CHECK(uri->path == "/a/b:c.pcap");
  CHECK(uri->option("meta") == "/x=y.json");
  CHECK(services::port_option(*uri).value() == 7502);
  CHECK_FALSE(uri->option("bind").has_value());
}

TEST_CASE("URIs that cannot be right are refused with the reason") {
  const auto contains = [](const std::string& uri, const std::string& part) {
    INFO(uri << ": " << open_error(uri));
    CHECK(open_error(uri).find(part) != std::string::npos);
  };
  contains("", "expected SCHEME:PATH");
  contains("file.pcap", "expected SCHEME:PATH");
  contains("ouster:?meta=a", "nothing between");
  contains("ouster:a.pcap?meta", "expected key=value, got 'meta'");
  contains("ouster:a.pcap?meta=", "expected key=value");
  contains("ouster:a.pcap?meta=a&meta=b", "'meta' is given twice");
  contains("ouster:a.pcap?metadata=a", "unknown option 'metadata' (ouster takes from, meta, port, serial)");
  contains("rosbag:a", "unknown scheme 'rosbag'");
  contains("ouster:a.pcap", "needs meta=FILE.json");
  contains("velodyne:a.pcap", "needs model=M (VLP-16, Puck-Hi-Res, VLP-32C, HDL-32, HDL-64E, VLS-128)");
  contains("velodyne:a.pcap?model=HDL-64", "unknown model 'HDL-64'");
  contains("velodyne:a.pcap?model=VLP-16&port=0", "port '0' is not a UDP port");
  contains("ouster:a.pcap?meta=a&serial=x", "a: cannot read the sensor's metadata");
  contains("velodyne:a.pcap?model=VLP-16&model_byte=", "expected key=value");
  contains("velodyne:a.pcap?model=VLP-16&model_byte=256",
           "model_byte '256' is not a whole number of at most 255");
  contains("velodyne-udp:70000?model=VLP-16", "'70000' is not a UDP port");
  contains("velodyne-udp:2368?model=VLP-16&bind=nonsense", "'nonsense' is not an IPv4 or IPv6 address");
  contains("scans:a?t=1", "unknown option 't' (scans takes floats, time)");
}
