//! Precomputed radiance transfer on the host's arrays: rays, transfer and visibility vectors, cache; CPU only.
