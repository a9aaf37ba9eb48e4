// SPDX-License-Identifier: GPL-3.0-or-later
// Operators of the language that parse but do not run yet: a scene that uses one is refused by name.
#include "msml/core/registry.hpp"

namespace msml::operators {
namespace {

struct Later {
  const char* tag;
  const char* doc;
};

constexpr Later all[] = {
    {"ACVDReduceSurfaceMesh", "Coarsen a surface to a number of vertices by clustering."},
    {"ApplyDVF", "Warp an image by a displacement vector field."},
    {"BoundsFromMaterialID", "Bounding box of the cells of one region."},
    {"CGALCalculateSubdivisionSurface", "Subdivide a surface (Catmull-Clark, Loop, Doo-Sabin, sqrt3)."},
    {"closestPoint", "The point of a mesh nearest to a position."},
    {"ColorMesh", "Colour surface elements so that neighbours differ."},
    {"ComputeDiceCoefficientPolydata", "Overlap of two closed surfaces."},
    {"ConvertVTKMeshToAbaqusMeshString", "A mesh as Abaqus input text."},
    {"ConvertVTKMeshToFeBioMeshString", "A mesh as FEBio geometry text."},
    {"ConvertVTKPolydataToCGALPolyhedron", "A surface as OFF text."},
    {"ExtractAllSurfacesByMaterial", "The outer surface of every region, beside the cells."},
    {"ExtractBoundarySurfaceByMaterials", "The faces where one region meets others."},
    {"GenerateDistanceMap", "Image of the distance to a mesh."},
    {"GenerateDistanceMap3d", "Image of the distance to a mesh by component."},
    {"GenerateDVF", "Image of the displacement between two meshes."},
    {"GradientOnSurface", "Values interpolated along x over the cells of a surface."},
    {"MorphCube", "Dilate and erode a label image."},
    {"ReplaceMaterialID", "Replace labels of an image."},
    {"SelectVolumesByMaterialID", "Keep the cells of some regions."},
    {"SurfaceFromVolumeAndNormalDirection", "The triangles that face one direction."},
    {"SurfaceMeshNumberOfElements", "Number of triangles."},
    {"SurfaceMeshSurfaceArea", "Area of a surface."},
    {"SurfaceMeshVolume", "Volume inside a closed surface."},
    {"TetgenCreateVolumeMesh", "Fill a closed surface with TetGen."},
    {"TransformMeshBarycentric", "Carry a volume mesh along with a deformed mesh."},
    {"TransformSurfaceBarycentric", "Carry a surface along with a deformed mesh."},
    {"vtkSmoothMesh", "Smooth a surface with a windowed sinc filter."},
};

}  // namespace

void add_later_operators(Registry& registry) {
  for (const Later& later : all) {
    Description description(later.tag, "operator", later.doc);
    const bool meshing = std::string(later.tag) == "TetgenCreateVolumeMesh";
    description.not_available_yet(meshing ? "mesh the surface with CGALMeshVolumeFromSurface instead"
                                          : "this operator of the language is still to be built");
    registry.add(std::make_shared<const Description>(std::move(description)));
  }
}

}  // namespace msml::operators
