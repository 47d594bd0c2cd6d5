"""The solver: model, flight, contact, friction, and the event loop that joins them."""
