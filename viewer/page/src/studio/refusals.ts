// SPDX-License-Identifier: GPL-3.0-or-later
import { text } from '../languages/text';

/** What the gateway may answer, for the catalogues (viewer/gateway: studio, studio_choices, surface_kind). */
export const refusals = (): string[] => [
  text('this file is no surface: STL, OBJ, PLY, OFF, glTF, VTP, VTU and HDF5 are taken'),
  text('this file is empty'),
  text('this file is too large: 700 MB are taken'),
  text('this file is too large: 220 MB are taken of a surface'),
  text('this scan needs another file: write it as one .nii file'),
  text('this scan needs another file: write it as one .nrrd file'),
  text('this scan needs another file: write it as one .mha file'),
  text('this compressed file is no scan: NIfTI is taken'),
  text('this glTF needs other files: write it as one .glb file'),
  text('this VTK file holds no surface: write it as PolyData (.vtp)'),
  text('this case is being built'),
  text('the file must be read first'),
  text('the case must be built first'),
  text('the case is at work; wait, or cancel it'),
  text('the project cannot be written: is the disk full?'),
  text('there is no such project'),
  text('there is a scene of this name already'),
  text('a name has letters, digits, _ and - only, 64 at most'),
  text('only for pages on this machine and instructors'),
  text('exercises are played at the machine of the case builder'),
];
