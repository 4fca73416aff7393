#include "tools/evaluation/recording_run.hpp"

#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/evaluation/recording_judge.hpp"
#include "tools/evaluation/recording_picture.hpp"
#include "tools/evaluation/recordings.hpp"
#include "tools/map/offline.hpp"
#include "tools/mapping/pipeline.hpp"

namespace gvom::evaluation {
namespace {

/// Makes the layers of what is fused so far. The frame borrows them.
tl::expected<Frame, std::string> make_frame(tools::OfflineMapper& mapper, const LayerArrays& layers) {
  if (const auto made = mapper.make_layers(layers); !made) return tl::unexpected(made.error().what);
  const LayerMoment moment = mapper.fuser().moment();
  Frame frame;
  frame.base_m = moment.T_odom_base.translation_m.head<2>();
  frame.forward = (moment.T_odom_base.rotation * Eigen::Vector3d::UnitX()).head<2>().normalized();
  frame.origin = {moment.grid.origin[0], moment.grid.origin[1]};
  frame.size = moment.grid.size[0];
  frame.height = layers.height;
  frame.flags = layers.flags;
  frame.visibility = layers.visibility;
  return frame;
}

tl::expected<void, std::string> draw(const Plan& plan, const Recording& recording, const Row& row,
                                     const Frame& frame) {
  if (plan.pictures_directory.empty()) return {};
  return draw_recording(recording.known, frame, row.name())
      .write_png(plan.pictures_directory + "/" + row.scene + "-" + row.sensor + ".png");
}

tl::expected<Row, std::string> run_recording(const Plan& plan, const Recording& recording) {
  Row row{recording.scene, recording.sensor, kRealDrive, {}};
  const auto wrong = [&](const std::string& why) { return tl::unexpected(row.name() + ": " + why); };
  auto mapper = tools::OfflineMapper::open(recording.vehicle, recording.odometry);
  if (!mapper) return wrong(mapper.error().what);
  const MapperConfig& config = recording.vehicle.mapper;
  const auto full = static_cast<std::size_t>(config.window.buffer_size) * recording.vehicle.lidars.size();
  const mapping::LayerStorage layers(config.map);
  RecordingJudge judge(recording.known);
  tl::expected<Frame, std::string> frame = tl::unexpected(std::string("no sweep could be mapped"));
  tools::MappedSweep mapped;
  for (std::size_t sweeps = 0;;) {
    const auto more = mapper->next(mapped);
    if (!more) return wrong(more.error().what);
    if (*more && ++sweeps < full) continue;
    if (*more || (sweeps > 0 && sweeps < full)) {
      frame = make_frame(*mapper, layers.arrays());
      if (!frame) return wrong(frame.error());
      judge.add(*frame);
    }
    if (!*more) break;
  }
  if (!frame) return wrong(frame.error());
  if (const auto drawn = draw(plan, recording, row, *frame); !drawn) return wrong(drawn.error());
  row.figures = judge.result();
  return row;
}

}  // namespace

tl::expected<std::vector<Row>, std::string> run_recordings(const Plan& plan, const Tell& tell) {
  std::vector<Row> rows;
  if (plan.recordings_directory.empty()) return rows;
  const auto found = find_recordings(plan.recordings_directory, plan.vehicle.mapper);
  if (!found) return tl::unexpected(found.error());
  for (const std::string& folder : found->missing) tell("SKIPPED: there is no recording " + folder);
  for (const Recording& recording : found->recordings) {
    auto row = run_recording(plan, recording);
    if (!row) return tl::unexpected(row.error());
    tell("recording " + row->name() + ": " + std::to_string(recording.known.count(Known::drivable)) +
         " columns known to be drivable, " + std::to_string(recording.known.count(Known::tree)) + " trees, " +
         std::to_string(recording.known.count(Known::bush)) + " bushes");
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace gvom::evaluation
