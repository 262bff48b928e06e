"""Goldman's fake fur: coats whose single hairs cannot be seen, shaded in one evaluation per light."""
