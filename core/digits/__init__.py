"""Numbers to as many digits as needed: written exactly, enclosed in balls, printed when their digits are proven."""
