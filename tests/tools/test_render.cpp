// What a picture shows, read back from the PNG file pixel by pixel.
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <png.h>
#include <catch2/catch.hpp>

#include "tests/tools/layers_fixture.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/snapshot/folder.hpp"
#include "tools/snapshot/output.hpp"
#include "tools/snapshot/render.hpp"

using namespace gvom::snapshot;
using gvom::LayerId;
using gvom::test::FlatWorld;
using gvom::test::TemporaryFolder;

namespace {

class Png {
 public:
  explicit Png(const std::string& path) {
    image_.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&image_, path.c_str()) != 0);
    image_.format = PNG_FORMAT_RGB;
    pixels_.resize(PNG_IMAGE_SIZE(image_));
    REQUIRE(png_image_finish_read(&image_, nullptr, pixels_.data(), 0, nullptr) != 0);
  }
  [[nodiscard]] int width() const { return static_cast<int>(image_.width); }
  [[nodiscard]] int height() const { return static_cast<int>(image_.height); }
  [[nodiscard]] Rgb at(int x, int y) const {
    const std::size_t i = 3 * (static_cast<std::size_t>(y) * image_.width + static_cast<std::size_t>(x));
    return {pixels_[i], pixels_[i + 1], pixels_[i + 2]};
  }

 private:
  png_image image_{};
  std::vector<std::uint8_t> pixels_;
};

/// The picture of one layer, and where its columns are.
struct LayerPng {
  LayerPng(const FlatWorld& world, LayerId layer)
      : area(layer_map_area(FlatWorld::kSize)), png(draw(world, layer)) {}

  /// The middle of a column's block.
  [[nodiscard]] Rgb column(int x, int y) const {
    return png.at(area.column_left(x) + area.zoom / 2, area.column_top(y) + area.zoom / 2);
  }

  MapArea area;
  Png png;

 private:
  static Png draw(const FlatWorld& world, LayerId layer) {
    const TemporaryFolder folder;
    const std::string path = folder.path() + "/layer.png";
    const LayersPicture picture = world.picture();
    REQUIRE(render_layer(picture, make_panel(layer, picture)).write_png(path));
    return Png(path);
  }
};

bool is_red(Rgb c) {
  return c.r > c.g && c.r > c.b && c.g < 40 && c.b < 40;
}

}  // namespace

TEST_CASE("every column is a block of at least two pixels") {
  for (const int n_xy : {8, 64, 200, 256, 1024}) CHECK(layer_map_area(n_xy).zoom >= 2);
}

TEST_CASE("+y is up and +x is right") {
  const MapArea area = layer_map_area(FlatWorld::kSize);
  CHECK(area.column_top(1) == area.column_top(0) - area.zoom);
  CHECK(area.column_left(1) == area.column_left(0) + area.zoom);
  CHECK(area.column_top(FlatWorld::kSize - 1) == area.top);
}

TEST_CASE("a hard column is red at its place, and only there") {
  FlatWorld world;
  world.make_hard(20, 5);
  const LayerPng picture(world, LayerId::obstacle_density);
  CHECK(is_red(picture.column(20, 5)) == true);
  CHECK(picture.column(20, 5) == kReds.at(1.0));
  CHECK(picture.column(21, 5) == kPlainGround);
  CHECK(picture.column(20, 6) == kPlainGround);
  CHECK(picture.column(5, 20) == kPlainGround);
  const int left = picture.area.column_left(20);
  const int top = picture.area.column_top(5);
  CHECK(picture.png.at(left, top) == kReds.at(1.0));
  CHECK(picture.png.at(left - 1, top) == kPlainGround);
  CHECK(picture.png.at(left, top - 1) == kPlainGround);
}

TEST_CASE("unknown is the neutral colour in every layer") {
  const FlatWorld world;
  for (int layer = 0; layer < gvom::kLayers; ++layer) {
    INFO(kLayerNames[static_cast<std::size_t>(layer)]);
    const LayerPng picture(world, static_cast<LayerId>(layer));
    CHECK(picture.column(3, 30) == kUnknown);
    if (static_cast<LayerId>(layer) != LayerId::inferred_height) CHECK(picture.column(3, 3) != kUnknown);
  }
}

TEST_CASE("no colour of any map is near the colour of unknown") {
  for (const ColourMap* map :
       {&kDepths, &kHeat, &kFreshness, &kDiverging, &kGreens, &kReds, &kViolets, &kTraffic, &kLowRoof})
    for (int i = 0; i <= 100; ++i) {
      const Rgb c = map->at(i / 100.0);
      const int distance =
          std::abs(c.r - kUnknown.r) + std::abs(c.g - kUnknown.g) + std::abs(c.b - kUnknown.b);
      CHECK(distance > 30);
    }
}

TEST_CASE("flat ground in noise looks flat") {
  FlatWorld world;
  auto& height = world.layer_f(LayerId::height);
  height[FlatWorld::at(2, 2)] = 0.97F;
  height[FlatWorld::at(2, 3)] = 1.03F;
  const LayerPng picture(world, LayerId::height);
  const Rgb low = picture.column(2, 2);
  const Rgb high = picture.column(2, 3);
  CHECK(std::abs(low.r - high.r) + std::abs(low.g - high.g) + std::abs(low.b - high.b) < 30);
}

TEST_CASE("the vehicle stands at its place and looks where it goes") {
  const FlatWorld world;
  const LayerPng picture(world, LayerId::obstacle_density);
  const int x = picture.area.column_left(8);  // at column 8.0
  const int y = picture.area.column_top(15);  // and row 16.0, the edge above row 15
  const Rgb white{255, 255, 255};
  CHECK(picture.png.at(x, y) == white);
  CHECK(picture.png.at(x, y - 8) == white);   // the nose is up
  CHECK(picture.png.at(x, y + 12) != white);  // the notch of the tail
}

TEST_CASE("lethal, unknown and free cost are three colours") {
  FlatWorld world;
  world.make_hard(1, 1);
  const LayerPng picture(world, LayerId::cost);
  CHECK(picture.column(1, 1) == kLethal);
  CHECK(picture.column(2, 1) == kTraffic.at(0.0));
  CHECK(picture.column(2, 30) == kUnknown);
}

TEST_CASE("nothing overhead is not a clearance") {
  FlatWorld world;
  world.layer_f(LayerId::clearance)[FlatWorld::at(4, 4)] = 2.5F;
  const LayerPng picture(world, LayerId::clearance);
  CHECK(picture.column(4, 4) == kLowRoof.at(2.5 / 6.0));
  CHECK(picture.column(5, 4) == kOpenSky);
}

TEST_CASE("a layer of nothing but unknown still makes a picture") {
  FlatWorld world;
  world.layer_f(LayerId::height).assign(FlatWorld::kSize * FlatWorld::kSize, std::nanf(""));
  CHECK(LayerPng(world, LayerId::height).column(3, 3) == kUnknown);
}

TEST_CASE("an output holds a montage, an overview and every layer; numbered ones stay") {
  const TemporaryFolder folder;
  FlatWorld world;
  auto output = Output::open({folder.path() + "/out", true, true});
  REQUIRE(output);
  for (int i = 0; i < 2; ++i) REQUIRE(output->write(world.picture()));
  for (const char* name : {"montage.png", "overview.png", "ground.png", "000000-montage.png",
                           "000001-montage.png", "000001/meta.json"})
    CHECK(std::filesystem::exists(folder.path() + "/out/" + name));
  for (const std::string_view name : kLayerNames) {
    const std::string layer(name);
    CHECK(std::filesystem::exists(folder.path() + "/out/" + layer + ".png"));
    CHECK(std::filesystem::exists(folder.path() + "/out/000000/" + layer + ".npy"));
  }
  const Png montage(folder.path() + "/out/montage.png");
  CHECK(montage.width() > 1600);
  CHECK(montage.height() > 1000);
}

TEST_CASE("an output that cannot be made is an error that names it") {
  const auto output = Output::open({"/proc/nothing/here", false, false});
  REQUIRE(!output);
  CHECK(output.error().find("/proc/nothing/here") != std::string::npos);
}

TEST_CASE("layers written to a folder come back to the byte") {
  const TemporaryFolder folder;
  FlatWorld world;
  world.make_hard(20, 5);
  const LayersPicture written = world.picture();
  REQUIRE(write_folder(folder.path() + "/000000", written));
  const auto read = read_folder(folder.path() + "/000000");
  REQUIRE(read);
  const LayersPicture& picture = read->picture;
  CHECK(picture.stamp_ns == written.stamp_ns);
  CHECK(picture.origin_voxels == written.origin_voxels);
  CHECK(picture.n_xy == written.n_xy);
  CHECK(picture.n_z == written.n_z);
  CHECK(picture.base_position_m == written.base_position_m);
  CHECK(picture.base_yaw_rad() == Approx(1.5707963));
  REQUIRE(picture.lidars.size() == 2);
  CHECK(picture.lidars[1].missing);
  for (std::size_t i = 0; i < world.floats.size(); ++i)
    CHECK(std::memcmp(picture.float_layers[i], written.float_layers[i], 4 * written.columns()) == 0);
  for (std::size_t i = 0; i < world.bytes.size(); ++i)
    CHECK(std::memcmp(picture.byte_layers[i], written.byte_layers[i], written.columns()) == 0);
}

TEST_CASE("a folder that is not whole is refused by file") {
  const TemporaryFolder folder;
  const FlatWorld world;
  const std::string path = folder.path() + "/000000";
  CHECK(read_folder(path).error().find("meta.json") != std::string::npos);
  REQUIRE(write_folder(path, world.picture()));
  std::filesystem::remove(path + "/slope.npy");
  CHECK(read_folder(path).error().find("slope.npy") != std::string::npos);
}

TEST_CASE("ticks are round numbers inside the scale") {
  const auto labels = [](const Scale& scale) {
    std::string all;
    for (const Tick& tick : ticks(scale, 5)) all += tick.label + " ";
    return all;
  };
  CHECK(labels({0, 1, false}) == "0.0 0.2 0.4 0.6 0.8 1.0 ");
  CHECK(labels({-1.1, 1.1, false}) == "-1.0 -0.5 0.0 0.5 1.0 ");
  CHECK(labels({1e-3, 1, true}) == "10⁻³ 10⁻² 10⁻¹ 1 ");
}

TEST_CASE("outliers do not widen a scale, and it is never narrower than asked") {
  std::vector<float> values(1000, 5.0F);
  values[0] = 1000.0F;
  values[1] = std::nanf("");
  const Scale scale = robust_scale(values.data(), values.size(), 1.0);
  CHECK(scale.low == Approx(4.5));
  CHECK(scale.high == Approx(5.5));
}
