#pragma once

/// Everything of Meshgrain's public API.

#include "meshgrain/clean.h"
#include "meshgrain/context.h"
#include "meshgrain/curvature.h"
#include "meshgrain/error.h"
#include "meshgrain/io.h"
#include "meshgrain/mesh.h"
#include "meshgrain/normals.h"
#include "meshgrain/picture.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/triangulate.h"
