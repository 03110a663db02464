//! glTF, environments and scene files to plain meshes, lights, images and cameras; every error names file, item and mend.
