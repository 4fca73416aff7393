// The truth as files: layers as .npy, and truth.json.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "tools/sim/ground_truth.hpp"
#include "tools/sim/recording.hpp"

namespace gvom::sim {

/// Errors name the file.
tl::expected<void, std::string> write_truth(const Scene& scene, const GroundTruth& truth,
                                            const std::string& directory);

}  // namespace gvom::sim
