// What a run says: tables for people, JSON for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/benchmark/recording.hpp"
#include "tools/benchmark/samples.hpp"

namespace gvom::bench {

/// Where and on what was measured.
struct Setting {
  std::string command;
  std::string machine;
  std::string recording;
  std::size_t sweeps;
  double returns_per_sweep;
};

Setting setting_of(const Recording& recording, const std::string& command);

struct Row {
  std::string name;
  double p50_ms;
  double p99_ms;
  std::size_t runs;
  std::optional<double> ratio;  ///< Median over that of the row it is compared with.
  std::string compared_with;
};

/// The one table of a run on the CPU alone.
struct Report {
  Setting setting;
  double passes_per_sweep = 0;
  double ns_per_pass = 0;  ///< Of counting and writing.
  std::vector<Row> rows;

  void add(const std::string& name, const Samples& samples) {
    rows.push_back({name, samples.quantile_ms(0.5), samples.quantile_ms(0.99), samples.size(), {}, {}});
  }
  /// A row with its ratio to an earlier one.
  void add(const std::string& name, const Samples& samples, const std::string& compared_with);
};

std::string table(const Report& report);
nlohmann::ordered_json to_json(const Report& report);

/// The JSON of any run starts with these.
nlohmann::ordered_json to_json(const Setting& setting);

}  // namespace gvom::bench
