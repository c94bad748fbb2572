// Robots in URDF as mechanisms: hamel run 'robot.urdf?wheel=left,right', or with --wheel.
//
//   link                        a body: mass, inertia about its mass centre; visuals (where all
//                               are meshes collisions) of boxes, cylinders, spheres are its shapes
//   revolute, continuous        hinge, with its damping
//   prismatic                   slider, the same
//   planar, floating, fixed     planar, free, weld
//   wheel=LINK[:kind][,radius=r]
//                               rolls on the ground, several separated by commas (urdf_wheels.hpp);
//                               wheel=auto: the links that look like wheels (urdf_shapes.hpp)
//   motor=JOINT                 has a motor, within its effort limit (urdf_joints.hpp)
//   weld=JOINT, weld-all-but=JOINT
//                               joints that are rigid in the drawn pose
//   joint-friction=JOINT|all    keeps the dry friction that the file states for a joint
//   root=planar|free|fixed      how the root link hangs on the ground; a root link named "world" is
//                               the ground
// The drawn pose is that of zero joint angles, along the axes of the root link; its height is such
// that the lowest wheel touches the ground. Not kept, with a note: limits of position and velocity,
// friction in joints (without joint-friction), meshes. Mimicking joints are coupled. Source:
// http://wiki.ros.org/urdf/XML.
#pragma once

#include <vector>

#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

/// The format by each of its extensions; its conversion is null in a build without urdfdom.
std::vector<FileFormat> urdf_formats();

}  // namespace hamel
