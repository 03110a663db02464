//! Spherical harmonics, sphere and cube maps, quadrature, sequences and error statistics; f64 truth and f32 use, no GPU.
