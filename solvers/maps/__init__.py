"""Seamless maps: a field integrated to images of edges, consistent up to quarter turns."""
