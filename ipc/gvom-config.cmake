# find_package(gvom): the library gvom::ipc.
include(CMakeFindDependencyMacro)
find_dependency(tl-expected)
find_dependency(iceoryx_hoofs)
find_dependency(iceoryx_posh)
include(${CMAKE_CURRENT_LIST_DIR}/gvom-targets.cmake)
