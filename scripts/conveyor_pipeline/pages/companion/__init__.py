"""The companion: solver, drawing, and the script that puts them into one HTML file."""
