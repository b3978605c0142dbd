#pragma once

namespace bio {

/// Two links of different kinds of joints, with a turned tensor and a turned frame.
inline constexpr const char* doublePendulumUrdf = R"(<robot name="double">
  <link name="world"/>
  <link name="upper"><inertial><origin xyz="0 0 -0.2" rpy="0 0 0.3"/><mass value="0.6"/>
    <inertia ixx="0.02" iyy="0.015" izz="0.004" ixy="0.001" ixz="0" iyz="0"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0.01 0 -0.25"/><mass value="0.4"/>
    <inertia ixx="0.01" iyy="0.012" izz="0.003" ixy="0" ixz="0.0005" iyz="0"/></inertial></link>
  <joint name="q1" type="continuous"><origin xyz="0 0 1"/><parent link="world"/><child link="upper"/>
    <axis xyz="0 1 0"/><dynamics damping="0.02" friction="0.03"/></joint>
  <joint name="q2" type="revolute"><origin xyz="0 0 -0.3" rpy="0 0 0.5"/><parent link="upper"/><child link="lower"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/><dynamics damping="0.01" friction="0"/></joint>
</robot>)";

}  // namespace bio
