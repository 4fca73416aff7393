// The comparison with the GPU as Markdown and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/benchmark/gpu.hpp"
#include "tools/benchmark/report.hpp"

namespace gvom::bench {

/// The key figures in a few lines.
std::string summary(const Setting& setting, const GpuComparison& comparison);
std::string markdown(const Setting& setting, const GpuComparison& comparison);
nlohmann::ordered_json to_json(const Setting& setting, const GpuComparison& comparison);

}  // namespace gvom::bench
