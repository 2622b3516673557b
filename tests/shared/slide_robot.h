#pragma once
// The files of a small robot for the tests of the loaders, and how to spoil them.

#include <gtest/gtest.h>

#include <string>

namespace tenon::tests {

inline constexpr const char* kSlideRobot = R"(name: slide
urdf: slide.urdf
bus: {bitrate_bps: 500000, cycle_us: 4000, heartbeat_ms: 100, heartbeat_timeout_ms: 300, master_node: 127}
arm: {response_lag_s: 0.008, stiffness_Npm: 1e6, measurement_delay_cycles: 1}
joints:
  - name: turn
    node: 2
    mode: 7
    counts_per_rad: 57295.779513
    zero_counts: 100
    acceleration_max_radps2: 10
    rated_effort_Nm: 20
    following_error_max_rad: 0.01
    stiffness_Nmpr: 2e4
  - name: x
    node: 1
    mode: 8
    counts_per_m: -1e6
    acceleration_max_mps2: 10
    rated_effort_N: 200
    following_error_max_m: 0.005
    stiffness_Npm: 1e6
sensor:
  node: 4
  force_per_count_N: 0.01
  torque_per_count_Nm: 0.0005
  force_range_N: 300
  torque_range_Nm: 15
  force_noise_N: 0.1
  torque_noise_Nm: 0.005
)";

// A slide that carries a turning arm, on a foot and with a tool plate that do not move by
// themselves.
inline constexpr const char* kSlideUrdf = R"(<robot name="slide">
  <link name="base"/>
  <link name="foot"/>
  <link name="carriage">
    <inertial>
      <origin xyz="0 0 0.1"/>
      <mass value="12"/>
      <inertia ixx="0.3" iyy="0.2" izz="0.1" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <link name="swing">
    <inertial>
      <origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/>
      <mass value="2"/>
      <inertia ixx="0.01" iyy="0.02" izz="0.025" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <link name="plate">
    <inertial>
      <mass value="2"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <joint name="bolts" type="fixed">
    <parent link="base"/> <child link="foot"/> <origin xyz="0 0 0.5"/>
  </joint>
  <joint name="x" type="prismatic">
    <parent link="foot"/> <child link="carriage"/> <origin xyz="0.2 0 0"/>
    <limit lower="-0.8" upper="0.8" velocity="1" effort="400"/>
  </joint>
  <joint name="turn" type="revolute">
    <parent link="carriage"/> <child link="swing"/> <origin xyz="0 0 0.1" rpy="0.5 0 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-2" upper="2.5" velocity="1.5" effort="40"/>
  </joint>
  <joint name="screws" type="fixed">
    <parent link="swing"/> <child link="plate"/> <origin xyz="0.3 0 0" rpy="0 0 0.25"/>
  </joint>
</robot>
)";

/// `text` with one piece of it replaced.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

}  // namespace tenon::tests
