"""Contact: stiffness and damping from materials and from how high a part bounces, and what their errors change."""
