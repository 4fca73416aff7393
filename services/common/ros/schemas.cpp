#include "services/common/ros/schemas.hpp"

#include <algorithm>
#include <vector>

namespace gvom::ros {
namespace {

struct Definition {
  std::string_view type;
  std::string_view text;
  std::vector<std::string_view> uses;  ///< In it directly.
  std::string_view hash;               ///< Empty: it is sent as a part of others only.
};

const std::vector<Definition>& definitions() {
  static const std::vector<Definition> all = {
      {"builtin_interfaces/msg/Time", "int32 sec\nuint32 nanosec\n", {}, ""},
      {"std_msgs/msg/Header",
       "builtin_interfaces/Time stamp\nstring frame_id\n",
       {"builtin_interfaces/msg/Time"},
       ""},
      {"std_msgs/msg/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n", {}, ""},
      {"std_msgs/msg/MultiArrayLayout",
       "MultiArrayDimension[] dim\nuint32 data_offset\n",
       {"std_msgs/msg/MultiArrayDimension"},
       ""},
      {"std_msgs/msg/Float32MultiArray",
       "MultiArrayLayout layout\nfloat32[] data\n",
       {"std_msgs/msg/MultiArrayLayout"},
       ""},
      {"geometry_msgs/msg/Point", "float64 x\nfloat64 y\nfloat64 z\n", {}, ""},
      {"geometry_msgs/msg/Vector3", "float64 x\nfloat64 y\nfloat64 z\n", {}, ""},
      {"geometry_msgs/msg/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n", {}, ""},
      {"geometry_msgs/msg/Pose",
       "Point position\nQuaternion orientation\n",
       {"geometry_msgs/msg/Point", "geometry_msgs/msg/Quaternion"},
       ""},
      {"geometry_msgs/msg/PoseStamped",
       "std_msgs/Header header\nPose pose\n",
       {"std_msgs/msg/Header", "geometry_msgs/msg/Pose"},
       ""},
      {"geometry_msgs/msg/Transform",
       "Vector3 translation\nQuaternion rotation\n",
       {"geometry_msgs/msg/Vector3", "geometry_msgs/msg/Quaternion"},
       ""},
      {"geometry_msgs/msg/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\nTransform transform\n",
       {"std_msgs/msg/Header", "geometry_msgs/msg/Transform"},
       ""},
      {"geometry_msgs/msg/PoseWithCovariance",
       "Pose pose\nfloat64[36] covariance\n",
       {"geometry_msgs/msg/Pose"},
       ""},
      {"geometry_msgs/msg/Twist", "Vector3 linear\nVector3 angular\n", {"geometry_msgs/msg/Vector3"}, ""},
      {"geometry_msgs/msg/TwistWithCovariance",
       "Twist twist\nfloat64[36] covariance\n",
       {"geometry_msgs/msg/Twist"},
       ""},
      {"nav_msgs/msg/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n",
       {"std_msgs/msg/Header", "geometry_msgs/msg/PoseWithCovariance",
        "geometry_msgs/msg/TwistWithCovariance"},
       "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
      {"nav_msgs/msg/MapMetaData",
       "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
       "geometry_msgs/Pose origin\n",
       {"builtin_interfaces/msg/Time", "geometry_msgs/msg/Pose"},
       ""},
      {"nav_msgs/msg/OccupancyGrid",
       "std_msgs/Header header\nMapMetaData info\nint8[] data\n",
       {"std_msgs/msg/Header", "nav_msgs/msg/MapMetaData"},
       "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7"},
      {"nav_msgs/msg/Path",
       "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n",
       {"std_msgs/msg/Header", "geometry_msgs/msg/PoseStamped"},
       "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"},
      {"grid_map_msgs/msg/GridMapInfo",
       "float64 resolution\nfloat64 length_x\nfloat64 length_y\ngeometry_msgs/Pose pose\n",
       {"geometry_msgs/msg/Pose"},
       ""},
      {"grid_map_msgs/msg/GridMap",
       "std_msgs/Header header\nGridMapInfo info\nstring[] layers\nstring[] basic_layers\n"
       "std_msgs/Float32MultiArray[] data\nuint16 outer_start_index\nuint16 inner_start_index\n",
       {"std_msgs/msg/Header", "grid_map_msgs/msg/GridMapInfo", "std_msgs/msg/Float32MultiArray"},
       "343b0e72887541beda6b035cc053f2d6fffaad9d6dcb2773c15a808dfca31fde"},
      {"sensor_msgs/msg/PointField",
       "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
       "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n",
       {},
       ""},
      {"sensor_msgs/msg/PointCloud2",
       "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
       "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
       {"std_msgs/msg/Header", "sensor_msgs/msg/PointField"},
       "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"},
      {"tf2_msgs/msg/TFMessage",
       "geometry_msgs/TransformStamped[] transforms\n",
       {"geometry_msgs/msg/TransformStamped"},
       "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
      {"diagnostic_msgs/msg/KeyValue", "string key\nstring value\n", {}, ""},
      {"diagnostic_msgs/msg/DiagnosticStatus",
       "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\n"
       "string hardware_id\nKeyValue[] values\n",
       {"diagnostic_msgs/msg/KeyValue"},
       ""},
      {"diagnostic_msgs/msg/DiagnosticArray",
       "std_msgs/Header header\nDiagnosticStatus[] status\n",
       {"std_msgs/msg/Header", "diagnostic_msgs/msg/DiagnosticStatus"},
       "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
      {"foxglove_msgs/msg/Vector2", "float64 x\nfloat64 y\n", {}, ""},
      {"foxglove_msgs/msg/PackedElementField",
       "uint8 UNKNOWN=0\nuint8 UINT8=1\nuint8 INT8=2\nuint8 UINT16=3\nuint8 INT16=4\nuint8 UINT32=5\n"
       "uint8 INT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 type\n",
       {},
       ""},
      {"foxglove_msgs/msg/Grid",
       "builtin_interfaces/Time timestamp\nstring frame_id\ngeometry_msgs/Pose pose\nuint32 column_count\n"
       "foxglove_msgs/Vector2 cell_size\nuint32 row_stride\nuint32 cell_stride\n"
       "foxglove_msgs/PackedElementField[] fields\nuint8[] data\n",
       {"builtin_interfaces/msg/Time", "geometry_msgs/msg/Pose", "foxglove_msgs/msg/Vector2",
        "foxglove_msgs/msg/PackedElementField"},
       "b0c6070e6d466742a149b77eda9ef066c31128f29858419125455d0943b0f867"},
  };
  return all;
}

const Definition* find(std::string_view type) {
  const auto& all = definitions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& d) { return d.type == type; });
  return found == all.end() ? nullptr : &*found;
}

const Definition* find_sent(std::string_view type) {
  const Definition* definition = find(type);
  return definition == nullptr || definition->hash.empty() ? nullptr : definition;
}

/// What `definition` uses, directly and by others, each once, behind what is there already.
void gather(const Definition& definition, std::vector<const Definition*>& into) {
  for (const std::string_view name : definition.uses) {
    const Definition* used = find(name);
    if (std::find(into.begin(), into.end(), used) != into.end()) continue;
    into.push_back(used);
    gather(*used, into);
  }
}

/// "nav_msgs/msg/Path" -> "nav_msgs/Path".
std::string short_name(std::string_view type) {
  std::string name(type);
  return name.erase(name.find("/msg"), 4);
}

}  // namespace

std::optional<std::string> schema_of(std::string_view type) {
  const Definition* definition = find_sent(type);
  if (definition == nullptr) return std::nullopt;
  std::vector<const Definition*> used;
  gather(*definition, used);
  std::string text(definition->text);
  for (const Definition* one : used)
    text += std::string(80, '=') + "\nMSG: " + short_name(one->type) + "\n" + std::string(one->text);
  return text;
}

std::optional<std::string> type_hash_of(std::string_view type) {
  const Definition* definition = find_sent(type);
  if (definition == nullptr) return std::nullopt;
  return "RIHS01_" + std::string(definition->hash);
}

}  // namespace gvom::ros
