#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a VTU or VTP file as a PNG; needs python3-vtk9, python3-numpy, and xvfb-run without a display."""
import argparse

import vtk
from vtk.util.numpy_support import vtk_to_numpy


def read(path):
    if path.endswith(".vtp"):
        reader = vtk.vtkXMLPolyDataReader()
    elif path.endswith(".vtk"):
        reader = vtk.vtkGenericDataObjectReader()
    else:
        reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def clipped(data, text):
    """What lies behind a plane "x y z nx ny nz", whole elements kept."""
    numbers = [float(word) for word in text.split()]
    plane = vtk.vtkPlane()
    plane.SetOrigin(numbers[:3])
    plane.SetNormal(numbers[3:])
    cut = vtk.vtkExtractGeometry()
    cut.SetInputData(data)
    cut.SetImplicitFunction(plane)
    cut.ExtractInsideOff()
    cut.Update()
    return cut.GetOutput()


def surface(data, detail):
    skin = vtk.vtkDataSetSurfaceFilter()
    skin.SetInputData(data)
    skin.SetNonlinearSubdivisionLevel(detail)
    skin.Update()
    return skin.GetOutput()


def undeformed(data):
    """A copy at x - u, or None where there is no displacement."""
    u = data.GetPointData().GetArray("displacement")
    if u is None:
        return None
    copy = data.NewInstance()
    copy.DeepCopy(data)
    points = vtk_to_numpy(copy.GetPoints().GetData())
    points -= vtk_to_numpy(u)
    return copy


def field_of(data, name):
    for attributes, mode in ((data.GetPointData(), "point"), (data.GetCellData(), "cell")):
        array = attributes.GetArray(name) if name else None
        if array is not None:
            return array, mode
    return None, None


def coloured(mapper, skin, name, limits):
    array, mode = field_of(skin, name)
    if array is None:
        mapper.ScalarVisibilityOff()
        return None
    table = vtk.vtkLookupTable()
    table.SetHueRange(0.62, 0.03)
    table.SetSaturationRange(0.75, 0.85)
    table.SetValueRange(0.9, 0.95)
    mapper.SetScalarRange(limits or array.GetRange(-1 if array.GetNumberOfComponents() > 1 else 0))
    if array.GetNumberOfComponents() > 1:
        table.SetVectorModeToMagnitude()
    table.Build()
    mapper.SetLookupTable(table)
    if mode == "point":
        mapper.SetScalarModeToUsePointFieldData()
    else:
        mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray(name)
    return table


def actor_of(skin, args):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(skin)
    table = coloured(mapper, skin, args.field, args.range)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.85, 0.72, 0.6)
    actor.GetProperty().SetAmbient(0.25)
    actor.GetProperty().SetDiffuse(0.8)
    if args.edges:
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(0.2, 0.2, 0.2)
        actor.GetProperty().SetLineWidth(1)
    return actor, table


def outline_of(data):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.45, 0.45, 0.45)
    actor.GetProperty().SetOpacity(0.22)
    return actor


def legend(table, title):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle(title)
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.3g")
    bar.SetPosition(0.84, 0.1)
    bar.SetWidth(0.15)
    bar.SetHeight(0.8)
    bar.SetBarRatio(0.2)
    bar.SetVerticalTitleSeparation(14)
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.SetFontSize(15)
        text.ShadowOff()
        text.ItalicOff()
        text.BoldOff()
    return bar


def look(renderer, args):
    camera = renderer.GetActiveCamera()
    direction = [float(word) for word in args.view.split()]
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*direction)
    camera.SetViewUp(*[float(word) for word in args.up.split()])
    camera.ParallelProjectionOn()
    renderer.ResetCamera()
    camera.Zoom(args.zoom)


def save(renderer, path, width, height):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(path)
    writer.Write()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result")
    parser.add_argument("picture")
    parser.add_argument("--field", default="", help="point or cell array to colour by; vectors by their length")
    parser.add_argument("--title", default="")
    parser.add_argument("--range", type=float, nargs=2)
    parser.add_argument("--view", default="1 -1 0.6", help="from where to look")
    parser.add_argument("--up", default="0 0 1")
    parser.add_argument("--clip", default="", help='"x y z nx ny nz": keep elements on the side of the normal')
    parser.add_argument("--edges", action="store_true")
    parser.add_argument("--outline", action="store_true", help="show the undeformed body too")
    parser.add_argument("--detail", type=int, default=1, help="subdivisions of a quadratic face")
    parser.add_argument("--zoom", type=float, default=1.0)
    parser.add_argument("--size", type=int, nargs=2, default=(800, 520))
    args = parser.parse_args()

    data = read(args.result)
    if args.clip:
        data = clipped(data, args.clip)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    actor, table = actor_of(surface(data, args.detail), args)
    renderer.AddActor(actor)
    rest = undeformed(data) if args.outline else None
    if rest is not None:
        renderer.AddActor(outline_of(surface(rest, args.detail)))
    if table is not None:
        renderer.AddActor2D(legend(table, args.title or args.field))
    look(renderer, args)
    save(renderer, args.picture, *args.size)


if __name__ == "__main__":
    main()
