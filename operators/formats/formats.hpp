// SPDX-License-Identifier: GPL-3.0-or-later
// The file formats, one function each, and what they share.
#pragma once
#include <filesystem>
#include <functional>

#include "msml/core/registry.hpp"

namespace msml::operators {

Format legacy_vtk();     ///< .vtk: unstructured grid, polydata, structured points; ASCII and binary
Format vtk_xml_grid();   ///< .vtu
Format vtk_xml_poly();   ///< .vtp
Format vtk_xml_image();  ///< .vti
Format stl();            ///< .stl, ASCII and binary
Format off();            ///< .off
Format obj();            ///< .obj, positions and faces only
Format ply();            ///< .ply, ASCII and binary
Format medit();          ///< .mesh, ASCII
Format gmsh();           ///< .msh, version 2.2, ASCII
Format inrimage();       ///< .inr, .inr.gz
Format nifti();          ///< .nii, .nii.gz
Format meta_image();     ///< .mha
Format nrrd();           ///< .nrrd

/// Runs a reader or writer; every Error and standard exception inside gets "PATH: " before its message.
Value reading(const std::filesystem::path& path, const std::function<Value()>& read);
void writing(const std::filesystem::path& path, const std::function<void()>& write);

/// The mesh as the wanted type: Mesh, or Surface where all its cells are triangles (see to_surface).
Value as_wanted(Mesh mesh, Type wanted);
/// The surface as the wanted type: itself, or a Mesh of tri3 cells whose region ids are the cell field "region".
Value as_wanted(Surface surface, Type wanted);
/// The Mesh in a value that holds a Mesh or a Surface.
MeshPtr mesh_in(const Value& value);

/// The whole file as text. Throws Error if it cannot be read.
std::string text_of(const std::filesystem::path& path);
/// Writes bytes to exactly this path. Throws Error, with the system's reason, if that fails.
void put(const std::filesystem::path& path, const std::string& bytes);

/// Lets a library that looks at file extensions write to path + extension, then renames that file to path.
void write_with_extension(const std::filesystem::path& path, const std::string& extension,
                          const std::function<void(const std::string& name)>& write);

/// Throws Error if the image is turned; for formats that cannot say so. `instead` names formats that can.
void require_upright(const Image& image);

/// A format that is one text: parsed to a mesh (or a surface, where its cells are triangles), and written from one.
Format mesh_text_format(std::string extension, std::string doc, Mesh (*parse)(const std::string&),
                        std::string (*written)(const Mesh&));
/// A format whose file is parsed to an image as a whole, and written from one.
Format image_text_format(std::string extension, std::string doc, Image (*parse)(const std::string&),
                         std::string (*written)(const Image&));

}  // namespace msml::operators
