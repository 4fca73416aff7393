// What stands above a picture of a drive.
#pragma once

#include <string>

namespace gvom::driving {

struct PictureWords {
  std::string title;     ///< What was driven.
  std::string subtitle;  ///< What came of it.
};

}  // namespace gvom::driving
