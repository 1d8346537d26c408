"""Cross-fields: isotropic, aligned, anisotropic, natural, and what they are worth."""
