//! Pictures: pixel buffers typed by what their numbers mean, tone curves, encoders, decoders and metrics.
