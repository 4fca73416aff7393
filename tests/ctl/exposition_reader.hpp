// Reads Prometheus's text format, strictly: what a scraper would refuse is an error here.
#pragma once

#include <map>
#include <string>

namespace gvom::test {

struct MetricFamily {
  std::string type;
  std::string help;
  std::map<std::string, double> samples;  ///< By their labels as they stand, `{a="b"}`, or empty.
};

/// Throws std::runtime_error with the line if: a sample comes without HELP and TYPE before it or away from
/// its family, a name, label or number is malformed, a sample comes twice, a counter does not end in _total
/// (or another does), the last line is not ended.
std::map<std::string, MetricFamily> read_exposition(const std::string& text);

}  // namespace gvom::test
