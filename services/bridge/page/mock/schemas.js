/** The `ros2msg` texts of what the mock sends. */
const LINE = `\n${'='.repeat(80)}\n`;

const PARTS = {
  'std_msgs/Header': 'builtin_interfaces/Time stamp\nstring frame_id',
  'builtin_interfaces/Time': 'int32 sec\nuint32 nanosec',
  'geometry_msgs/Point': 'float64 x\nfloat64 y\nfloat64 z',
  'geometry_msgs/Vector3': 'float64 x\nfloat64 y\nfloat64 z',
  'geometry_msgs/Quaternion': 'float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1',
  'geometry_msgs/Pose': 'Point position\nQuaternion orientation',
  'geometry_msgs/PoseStamped': 'std_msgs/Header header\nPose pose',
  'geometry_msgs/Transform': 'Vector3 translation\nQuaternion rotation',
  'geometry_msgs/TransformStamped': 'std_msgs/Header header\nstring child_frame_id\nTransform transform',
  'foxglove_msgs/Vector2': 'float64 x\nfloat64 y',
  'foxglove_msgs/PackedElementField': 'uint8 UNKNOWN=0\nuint8 UINT8=1\nuint8 FLOAT32=7\nstring name\nuint32 offset\nuint8 type',
  'sensor_msgs/PointField': 'uint8 FLOAT32 = 7\nstring name\nuint32 offset\nuint8 datatype\nuint32 count',
};
const POSE = ['geometry_msgs/Pose', 'geometry_msgs/Point', 'geometry_msgs/Quaternion'];
const HEADER = ['std_msgs/Header', 'builtin_interfaces/Time'];

function schema(text, parts) {
  return text + parts.map((name) => `${LINE}MSG: ${name}\n${PARTS[name]}`).join('');
}

export const SCHEMAS = {
  'foxglove_msgs/msg/Grid': schema(
    `# Layers of a map.
builtin_interfaces/Time timestamp
string frame_id
geometry_msgs/Pose pose
uint32 column_count
foxglove_msgs/Vector2 cell_size
uint32 row_stride
uint32 cell_stride
foxglove_msgs/PackedElementField[] fields
uint8[] data`,
    ['builtin_interfaces/Time', ...POSE, 'foxglove_msgs/Vector2', 'foxglove_msgs/PackedElementField']),
  'sensor_msgs/msg/PointCloud2': schema(
    `std_msgs/Header header
uint32 height
uint32 width
PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense`,
    [...HEADER, 'sensor_msgs/PointField']),
  'nav_msgs/msg/Path': schema(
    'std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses', [...HEADER, 'geometry_msgs/PoseStamped', ...POSE]),
  'tf2_msgs/msg/TFMessage': schema(
    'geometry_msgs/TransformStamped[] transforms',
    [...HEADER, 'geometry_msgs/TransformStamped', 'geometry_msgs/Transform', 'geometry_msgs/Vector3', 'geometry_msgs/Quaternion']),
};
