# The requirements are taken from the packages of Debian 12 (tools/setup), not from ConanCenter:
#
#   conan create tools/packages/conan -pr:a default -pr:a tools/packages/conan/debian.profile --no-remote
[platform_requires]
ceres-solver/2.1.0
eigen/3.4.0
fmt/9.1.0
hdf5/1.10.8
muparser/2.3.3
nlohmann_json/3.11.2
nlopt/2.7.1
tomlplusplus/3.3.0
zlib/1.2.13
