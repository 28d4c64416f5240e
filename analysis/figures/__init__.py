"""Plots: what is analysed, drawn for page and paper as SVG and PNG."""
