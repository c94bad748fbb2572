// Robots in URDF as mechanisms: hamel run 'robot.urdf?wheel=left,right', or with --wheel.
//
//   link                        a body: mass, inertia about its mass centre; visuals (where all
//                               are meshes collisions) of boxes, cylinders, spheres are its shapes
//   revolute, continuous        hinge, with its damping, and a motor within its effort limit
//   prismatic                   slider, the same
//   planar, floating, fixed     planar, free, weld
//   wheel=LINK[:wheel|:ball]    rolls on the ground, several separated by commas: a cylinder about
//                               its axis, or about that of its joint where the two are parallel; a
//                               sphere as a ball, or, with LINK:wheel, about the axis of its joint
//   root=planar|free|fixed      how the root link hangs on the ground; a root link named "world" is
//                               the ground
// The drawn pose is that of zero joint angles, along the axes of the root link; its height is such
// that the lowest wheel touches the ground. Not kept, with a note: limits of position and velocity,
// friction in joints, meshes. Mimicking joints are refused. Source: http://wiki.ros.org/urdf/XML.
#pragma once

#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

/// The format; its conversion is null in a build without urdfdom.
FileFormat urdf_format();

}  // namespace hamel
