/** Where the vehicle is: its position in odom and its turn. */

/**
 * @param {object} message tf2_msgs/msg/TFMessage
 * @param {string} frame of the map, the parent; its child called base-something is the vehicle, else its first
 * @returns {{x: number, y: number, z: number, quaternion: number[], yaw_rad: number} | null} metres; null if it is not in it
 */
export function pose_of(message, frame) {
  const from_map = message.transforms.filter(({ header }) => header.frame_id === frame);
  const found = from_map.find(({ child_frame_id }) => /base/.test(child_frame_id)) ?? from_map[0];
  if (!found) return null;
  const { translation, rotation: q } = found.transform;
  const yaw_rad = Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
  return { ...translation, quaternion: [q.x, q.y, q.z, q.w], yaw_rad };
}

/** @param {object} message nav_msgs/msg/Path @returns {{x: number, y: number, z: number}[]} in the map's frame, metres */
export function way_of(message) {
  return message.poses.map(({ pose }) => pose.position);
}
