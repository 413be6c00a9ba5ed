// What OpenSCAD programs import: drawings as areas, meshes as solids, measures of DXF files.
#pragma once

#include "front/scad/value/command.h"

namespace kerf {

scad::Imports scad_imports();

}  // namespace kerf
