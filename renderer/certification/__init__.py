"""The certificate: our pictures beside a path tracer's of the same eye, light and camera."""
