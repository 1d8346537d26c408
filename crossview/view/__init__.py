"""What a picture shows, as values: data, layers, colours, sizes. No VTK, no Qt."""
