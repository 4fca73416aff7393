// A map of a real recording as a picture, beside what is known of the place.
#pragma once

#include <string>

#include "tools/evaluation/frame.hpp"
#include "tools/evaluation/known_columns.hpp"
#include "tools/snapshot/canvas.hpp"

namespace gvom::evaluation {

/// One panel, or two where something is known.
snapshot::Canvas draw_recording(const KnownColumns& known, const Frame& frame, const std::string& title);

}  // namespace gvom::evaluation
