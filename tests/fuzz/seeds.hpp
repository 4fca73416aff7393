// The first inputs of the fuzz targets.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/ingest/frames_builder.hpp"

namespace gvom::fuzz {

/// A folder for each target, a file for each input.
class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void add(const std::string& target, const test::ByteVector& bytes) {
    const std::filesystem::path folder = folder_ / target;
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / ("seed" + std::to_string(count_++)), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  }
  void add(const std::string& target, const std::string& text) {
    add(target, test::ByteVector(text.begin(), text.end()));
  }

 private:
  std::filesystem::path folder_;
  std::size_t count_ = 0;
};

/// One valid message of each topic.
void add_messages(Seeds& seeds);

/// MCAP files and ROS 2 messages.
void add_bags(Seeds& seeds);

/// What clients of the bridge say.
void add_clients(Seeds& seeds);

}  // namespace gvom::fuzz
